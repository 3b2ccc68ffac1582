"""A month of nights on a study of many missions: python3 benches/nights.py FOLDER PROGRAM [NIGHTS]

FOLDER holds study.toml, ztbus/, weather/ and a database that is complete. The missions of the last NIGHTS days (30) and
the weather from then on go aside; then every night brings a day's missions and weather back. Every third run is killed
after a random time (seeded). Prints what each night took, and compares the last database with the first one, row by row
and bit by bit.
"""

import pathlib
import random
import re
import shutil
import subprocess
import sys
import time

folder, program = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
nights = int(sys.argv[3]) if len(sys.argv) > 3 else 30
compare = pathlib.Path(__file__).resolve().parent.parent / "tests" / "compare.py"
day_of = lambda path: re.match(r"B\d+_(\d{4}-\d{2}-\d{2})", path.name).group(1)
missions = sorted((folder / "ztbus").glob("B*.csv"), key=day_of)
days = sorted({day_of(m) for m in missions})[-nights:]
weather = max((folder / "weather").iterdir(), key=lambda path: path.name)
rows = weather.read_text().splitlines(keepends=True)
dice = random.Random(1)
run = [str(program), "run", "--quiet"]


def stamp(row):
    d, m, y = row.split(";")[1][:10].split(".")
    return f"{y}-{m}-{d}"


def weather_until(day):
    weather.write_text(rows[0] + "".join(row for row in rows[1:] if stamp(row) <= day))


subprocess.run(run, cwd=folder, check=False, stdout=subprocess.DEVNULL)
shutil.copy(folder / "study.db", folder / "reference.db")
aside = folder / "aside"
aside.mkdir(exist_ok=True)
for mission in missions:
    if day_of(mission) in days:
        mission.rename(aside / mission.name)
weather_until(min(days))
subprocess.run(run, cwd=folder, check=False, stdout=subprocess.DEVNULL)
time.sleep(2)
took = []
for night, day in enumerate(days, 1):
    for mission in aside.glob(f"B*_{day}_*.csv"):
        mission.rename(folder / "ztbus" / mission.name)
    if day == days[-1]:
        weather.write_text("".join(rows))
    else:
        weather_until(day)
    # What was written a moment ago is not believed by its look; no night is that short.
    time.sleep(2.5)
    begin = time.monotonic()
    if night % 3 == 0:
        child = subprocess.Popen(run, cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        wait = dice.uniform(0, 2.0)
        time.sleep(wait)
        child.kill()
        child.wait()
        print(f"{day}: killed after {wait:.2f} s", flush=True)
        continue
    status = subprocess.run(run, cwd=folder, check=False, stdout=subprocess.DEVNULL).returncode
    took.append(time.monotonic() - begin)
    size = (folder / "study.db").stat().st_size / 1e6
    print(f"{day}: {took[-1]:.2f} s, status {status}, {size:.1f} MB", flush=True)
subprocess.run(run, cwd=folder, check=True, stdout=subprocess.DEVNULL)
begin = time.monotonic()
subprocess.run(run, cwd=folder, check=True, stdout=subprocess.DEVNULL)
print(f"no change: {time.monotonic() - begin:.2f} s; nights: median {sorted(took)[len(took) // 2]:.2f} s, longest {max(took):.2f} s")
sys.exit(subprocess.run([sys.executable, compare, folder / "reference.db", folder / "study.db"]).returncode)
