"use strict";
// Readers choose series and windows, and read values from figures by pointer and by keys. The values are those of the tables
// behind the figures; without this script all of these are there, and nothing can be chosen.
(() => {
  const hidden = new Set();
  const all = (root, what) => [...root.querySelectorAll(what)];
  const make = (name, has, ...inner) => {
    const made = Object.assign(document.createElement(name), has);
    made.append(...inner);
    return made;
  };
  const isHidden = (title) => [...hidden].some((name) => title === name || title.startsWith(name + ", "));

  // Series: what is not chosen leaves figures and tables, wherever it has the same name.
  const figures = all(document, "figure").map((figure) => {
    const names = all(figure, "[data-legend] text").map((text) => text.textContent);
    const places = (group) => group.dataset.series.split(" ").map((place) => names[place]);
    const boxes = names.map((name) => {
      const box = make("input", { type: "checkbox", checked: true });
      box.addEventListener("change", () => {
        if (box.checked) hidden.delete(name);
        else hidden.add(name);
        apply();
      });
      return { name, box };
    });
    if (names.length > 1) {
      const labels = boxes.map(({ name, box }) => make("label", {}, box, name));
      const tools = make("div", { className: "tools" }, ...labels);
      tools.setAttribute("role", "group");
      tools.setAttribute("aria-label", "Shown in figures and tables");
      figure.querySelector(".plot").after(tools);
    }
    return () => {
      boxes.forEach(({ name, box }) => { box.checked = !hidden.has(name); });
      all(figure, "[data-series]").forEach((group) => {
        group.toggleAttribute("hidden", places(group).every((name) => hidden.has(name)));
      });
      all(figure, "[data-legend]").forEach((group) => group.classList.toggle("off", hidden.has(names[group.dataset.legend])));
    };
  });
  const tables = all(document, "table").map((table) => {
    const titles = [...table.tHead.rows[0].cells].map((cell) => cell.textContent);
    return () => [...table.rows].forEach((row) => {
      const isBody = row.parentNode !== table.tHead;
      row.hidden = isBody && hidden.has(row.cells[0].textContent);
      [...row.cells].forEach((cell, i) => { cell.hidden = i > 0 && isHidden(titles[i]); });
    });
  });
  const apply = () => [...figures, ...tables].forEach((change) => change());

  // Windows: all that can be chosen alike is chosen together.
  const choices = all(document, ".choice");
  choices.forEach((choice, place) => {
    const options = [...choice.children];
    const first = options.find((o) => o.open);
    options.forEach((o) => {
      Object.assign(o, { hidden: o !== first, open: true });
      o.querySelector("summary").hidden = true;
    });
    const id = "choice-" + place;
    const select = make("select", { id }, ...options.map((o) => make("option", { selected: o === first }, o.dataset.option)));
    select.addEventListener("change", () => choices.forEach((other) => {
      if (other.dataset.choice !== choice.dataset.choice) return;
      const wanted = [...other.children].filter((o) => o.dataset.option === select.value);
      if (wanted.length === 0) return;
      [...other.children].forEach((o) => { if (o.dataset.option !== undefined) o.hidden = o !== wanted[0]; });
      other.querySelector("select").value = select.value;
    }));
    choice.prepend(make("p", { className: "chooser" }, make("label", { htmlFor: id }, choice.dataset.choice + " ", select)));
  });

  // Values: a line at a row of the table behind the figure, and that row in words.
  all(document, "figure").forEach((figure) => {
    const panels = all(figure, "table[data-panel]").map((table) => ({
      table,
      at: table.tHead.rows[0].cells[0].textContent,
      titles: [...table.tHead.rows[0].cells].map((cell) => cell.textContent),
      rows: [...table.tBodies[0].rows],
      ends: table.dataset.panel.split(" ").map(Number),
    }));
    if (panels.length === 0) return;
    const plot = figure.querySelector(".plot");
    const svg = plot.querySelector("svg");
    const view = svg.viewBox.baseVal;
    const line = document.createElementNS(svg.namespaceURI, "path");
    line.setAttribute("class", "cursor");
    svg.append(line);
    const readout = make("p", { className: "readout" });
    readout.setAttribute("role", "status");
    plot.after(readout);
    Object.assign(plot, { tabIndex: 0 });
    plot.setAttribute("role", "group");
    plot.setAttribute("aria-label", svg.getAttribute("aria-label") + " Arrow keys read its values.");
    let now = [0, -1];
    const show = (panel, place) => {
      now = [panel, place];
      panels.forEach((p) => p.rows.forEach((row) => row.classList.remove("at")));
      const { at, titles, rows, ends, table } = panels[panel];
      const row = rows[place];
      if (row === undefined) {
        line.setAttribute("d", "");
        readout.textContent = "";
        return;
      }
      row.classList.add("at");
      line.setAttribute("d", "M" + row.dataset.x + " " + ends[1] + "V" + ends[3]);
      const told = [...row.cells].map((cell, i) => [cell, i]).filter(([cell, i]) => i > 0 && !cell.hidden);
      const words = told.map(([cell, i]) => titles[i] + " " + cell.textContent);
      readout.textContent = table.caption.textContent + ". " + at + " " + row.cells[0].textContent + ": " + words.join("; ");
    };
    const nearest = (panel, x) => {
      const off = panels[panel].rows.map((row) => Math.abs(Number(row.dataset.x) - x));
      return off.indexOf(Math.min(...off));
    };
    svg.addEventListener("pointermove", (event) => {
      const box = svg.getBoundingClientRect();
      const x = (event.clientX - box.left) / box.width * view.width;
      const y = (event.clientY - box.top) / box.height * view.height;
      const found = panels.findIndex(({ ends: [l, t, r, b] }) => x >= l && r >= x && y >= t && b >= y);
      if (found >= 0) show(found, nearest(found, x));
    });
    plot.addEventListener("keydown", (event) => {
      const last = panels[now[0]].rows.length - 1;
      const to = (place) => show(now[0], Math.max(0, Math.min(last, place)));
      const turn = (by) => {
        const panel = (now[0] + by + panels.length) % panels.length;
        show(panel, Math.max(0, Math.min(panels[panel].rows.length - 1, now[1])));
      };
      const keys = {
        ArrowRight: () => to(now[1] + 1),
        ArrowLeft: () => to(now[1] - 1),
        Home: () => to(0),
        End: () => to(last),
        ArrowDown: () => turn(1),
        ArrowUp: () => turn(-1),
        Escape: () => show(now[0], -1),
      };
      if (keys[event.key] === undefined) return;
      event.preventDefault();
      keys[event.key]();
    });
  });
})();
