// Opens a report in a browser as readers do, and says as JSON what there was: errors, requests, what choosing and reading does,
// what an accessibility checker finds, how it prints. Usage: node page.mjs FOLDER_OF_PACKAGES BROWSER PAGE
import { createRequire } from "node:module";
import { pathToFileURL } from "node:url";

const [packages, browserPath, pagePath] = process.argv.slice(2);
const require = createRequire(packages + "/");
const puppeteer = await import(pathToFileURL(require.resolve("puppeteer-core")).href);
const axe = require.resolve("axe-core/axe.min.js");
const url = pathToFileURL(pagePath).href;

const browser = await puppeteer.launch({
  executablePath: browserPath,
  args: ["--no-sandbox", "--disable-gpu", "--no-first-run", "--disable-background-networking", "--disable-component-update"],
});
const found = { errors: [], requests: [], views: [] };

const open = async (width, scheme, script = true) => {
  const page = await browser.newPage();
  page.on("console", (message) => {
    if (["error", "warn"].includes(message.type())) found.errors.push(message.text());
  });
  page.on("pageerror", (error) => found.errors.push(String(error)));
  page.on("request", (request) => {
    if (request.url() !== url) found.requests.push(request.url());
  });
  await page.setJavaScriptEnabled(script);
  await page.setViewport({ width, height: 900 });
  await page.emulateMediaFeatures([{ name: "prefers-color-scheme", value: scheme }]);
  await page.goto(url);
  return page;
};

// As it is read: wide and narrow, by day and by night.
for (const [width, scheme] of [[1400, "light"], [1400, "dark"], [400, "light"], [400, "dark"]]) {
  const page = await open(width, scheme);
  const wider = await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
  // The page forbids scripts that are not its own: the checker comes in past that, as extensions do.
  const checked = await browser.newPage();
  await checked.setBypassCSP(true);
  await checked.setViewport({ width, height: 900 });
  await checked.emulateMediaFeatures([{ name: "prefers-color-scheme", value: scheme }]);
  await checked.goto(url);
  await checked.evaluate(() => document.querySelectorAll("details").forEach((d) => { d.open = true; }));
  await checked.addScriptTag({ path: axe });
  const { violations } = await checked.evaluate(() => window.axe.run(document, {
    runOnly: ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa", "best-practice"],
  }));
  const told = violations.map((v) => ({ id: v.id, impact: v.impact, at: v.nodes.slice(0, 3).map((n) => n.target.join(" ")) }));
  found.views.push({ width, scheme, wider, violations: told });
  await checked.close();
  await page.close();
}

// What choosing and reading does.
const page = await open(1400, "light");
found.chosen = await page.evaluate(() => {
  const texts = (root, what) => [...root.querySelectorAll(what)].filter((e) => !e.hidden).map((e) => e.textContent);
  const link = document.querySelector('a[href="pareto.svg"]');
  const figure = link.closest("figure");
  const state = () => ({
    groups: figure.querySelectorAll("g[data-series]:not([hidden])").length,
    columns: texts(figure, "table thead th"),
    study: texts(figure.closest("section"), "section > .wide thead th"),
  });
  const before = state();
  const box = figure.querySelector("input[type=checkbox]");
  const name = box.parentNode.textContent;
  box.click();
  const after = state();
  const others = [...document.querySelectorAll("figure input[type=checkbox]")].filter((b) => b.parentNode.textContent === name);
  const alike = others.every((b) => !b.checked);
  box.click();
  return { name, before, after, alike, again: state() };
});
found.window = await page.evaluate(() => {
  const shown = () => [...document.querySelectorAll(".choice > [data-option]:not([hidden])")].map((o) => o.dataset.option);
  const figure = () => document.querySelector(".choice > [data-option]:not([hidden]) svg").outerHTML;
  const select = document.querySelector(".choice select");
  const [before, first] = [shown(), figure()];
  select.value = select.options[0].value;
  select.dispatchEvent(new Event("change"));
  const changed = figure() !== first;
  return { before, after: shown(), changed };
});
const plot = await page.evaluateHandle(() => document.querySelector('a[href="pareto.svg"]').closest("figure").querySelector(".plot"));
await plot.focus();
for (const key of ["ArrowRight", "ArrowRight"]) await page.keyboard.press(key);
const read = () => page.evaluate((plot) => {
  const figure = plot.closest("figure");
  const row = figure.querySelector("tr.at");
  return { readout: figure.querySelector(".readout").textContent, row: row ? [...row.cells].map((c) => c.textContent) : [] };
}, plot);
found.keys = await read();
await page.keyboard.press("Escape");
found.escaped = await read();
await plot.scrollIntoView();
const box = await plot.boundingBox();
await page.mouse.move(box.x + box.width / 2, box.y + box.height * 0.7);
found.pointer = await read();
found.bytes_of_script = await page.evaluate(() => document.querySelector("script").textContent.length);
const pdf = await page.pdf({ format: "A4", printBackground: true });
found.pdf_pages = (Buffer.from(pdf).toString("latin1").match(/\/Type\s*\/Page\b/g) ?? []).length;
await page.close();

// Without script.
const plain = await open(1400, "light", false);
found.plain = await plain.$$eval("svg", (all) => all.filter((s) => s.checkVisibility()).length);
found.plain_tables = await plain.$$eval("table", (all) => all.length);
found.plain_controls = await plain.$$eval("input, select, button", (all) => all.length);
await plain.close();

await browser.close();
console.log(JSON.stringify(found, null, 1));
