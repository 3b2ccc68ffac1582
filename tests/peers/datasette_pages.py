"""Datasette with the metadata of a study: titles, hidden tables, and every canned query over HTTP.

    datasette_pages.py DATABASE METADATA

Printed is a line for each thing that was asked for: what, name, `ok` or what is wrong.
"""

import csv
import json
import pathlib
import socket
import subprocess
import sys
import time
import urllib.request

database, metadata = sys.argv[1:]
with socket.socket() as free:
    free.bind(("127.0.0.1", 0))
    port = str(free.getsockname()[1])
# No proxy stands between a machine and itself.
urlopen = urllib.request.build_opener(urllib.request.ProxyHandler({})).open
arguments = [sys.executable, "-m", "datasette", "serve", "-i", database, "--metadata", metadata, "--port", port]
server = subprocess.Popen([*arguments, "--setting", "sql_time_limit_ms", "1000"], stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
base = f"http://127.0.0.1:{port}"
out = csv.writer(sys.stdout)
try:
    for _ in range(100):
        try:
            urlopen(f"{base}/-/versions.json", timeout=5).read()
            break
        except OSError:
            time.sleep(0.1)
    name = pathlib.Path(database).stem
    about = json.loads(pathlib.Path(metadata).read_text())
    page = urlopen(f"{base}/{name}", timeout=20).read().decode()
    out.writerow(["page", name, "ok" if "CC BY 4.0" in page and "next-tenth" in page else "no licence or no query"])
    tables = json.load(urlopen(f"{base}/{name}.json", timeout=20))["tables"]
    hidden = {t["name"] for t in tables if t["hidden"]}
    meant = {n for n, t in about["databases"][name]["tables"].items() if t.get("hidden")}
    out.writerow(["hidden", name, "ok" if meant <= hidden and "annual_average" not in hidden else f"{meant - hidden}"])
    page = urlopen(f"{base}/{name}/sample", timeout=20).read().decode()
    out.writerow(["columns", "sample", "ok" if "direct normal irradiance; mean [W/m²]" in page.replace(",", ";") else "no words"])
    for query in about["databases"][name]["queries"]:
        answer = json.load(urlopen(f"{base}/{name}/{query}.json?_shape=objects", timeout=20))
        ok = not answer.get("error") and isinstance(answer["rows"], list)
        out.writerow(["query", query, "ok" if ok else str(answer)[:200].replace(",", ";")])
finally:
    server.terminate()
    server.wait()
