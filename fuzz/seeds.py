"""Writes small inputs to start from: python3 fuzz/seeds.py PROGRAM."""

import pathlib
import subprocess
import sys
import tempfile
import zipfile

here = pathlib.Path(__file__).parent / "corpus"
scratch = pathlib.Path(tempfile.mkdtemp())
subprocess.run([sys.argv[1], "demo", scratch, "--missions", "1", "--quiet"], check=True)


def seed(target, name, data):
    folder = here / target
    folder.mkdir(parents=True, exist_ok=True)
    (folder / name).write_bytes(data if isinstance(data, bytes) else data.encode())


mission = next((scratch / "ztbus").glob("B*.csv"))
head = b"".join(mission.read_bytes().splitlines(keepends=True)[:60])
header, first = head.splitlines()[:2]
start = int(first.split(b",")[1])
# The target's mission begins at another second.
moved = head.replace(str(start)[:7].encode(), b"1627271")
seed("mission", "demo", moved)
seed("mission", "crlf", moved.replace(b"\n", b"\r\n"))
seed("mission", "flags", moved.replace(b",1,1,", b",True,1,").replace(b"NaN", b""))
rows = "".join(
    f"{1600000000 + 5 * n + 2000 * (n // 10)},Bus {183 + n % 2},{n}.5,{n % 4 // 3},{n}.25,{n},-\n" for n in range(40)
)
seed("table", "many", b"\0when,bus,load,doors,speed,power,line\n" + rows.encode())
seed("table", "one", b"\7when;bus;load;doors;speed;power;line\r\n2021-03-28 01:59:00;;1;0.5;;;\r\n2021-03-28 03:00:00;;1;0;;;\r\n")
seed("metadata", "demo", (scratch / "ztbus" / "metaData.csv").read_bytes())
seed("shadow", "demo", (scratch / "shadow.csv").read_bytes()[:4000])
seed("study", "demo", (scratch / "study.toml").read_bytes())
archive = scratch / "a.zip"
for name, method in [("deflated", zipfile.ZIP_DEFLATED), ("stored", zipfile.ZIP_STORED)]:
    with zipfile.ZipFile(archive, "w", method) as file:
        file.writestr(mission.name, moved)
        file.writestr("../climbs.csv", "a,b\n")
        file.writestr("__MACOSX/._x.csv", "")
    seed("archive", name, archive.read_bytes())

epw = "LOCATION,x,-,CHE,x,1,47.4,8.6,1.0,500\n" + "COMMENTS\n" * 6 + "DATA PERIODS,1,1,Data,Sunday,1/1,12/31\n"
epw += "".join(f"2001,1,1,{h},60,x,{h}.5,0,0,0,0,0,0,0,0,0\n" for h in range(1, 25))
stamps = [f"2021-06-21T{h:02}:00" for h in range(24)]
weather = [
    "station_abbr;reference_timestamp;tre200h0;gre000h0;ods000h0\n"
    + "".join(f"SMA;21.06.2021 {h:02}:00;{h}.5;0;\n" for h in range(24)),
    "station,time.yy,time.mm,time.dd,time.hh,temp,rad.global,rad.direct,rad.diffus\n"
    + "".join(f"SMA,2001,6,21,{h},{h},0,0,0\n" for h in range(24)),
    epw,
    "Latitude (decimal degrees): 47.4\nLongitude (decimal degrees): 8.6\n\ntime(UTC),T2m,G(h),Gb(n),Gd(h)\n"
    + "".join(f"20180621:{h:02}00,{h},0,0,0\n" for h in range(24)) + "\nT2m: x\n",
    "latitude,longitude,elevation,utc_offset_seconds\n47.4,8.6,450.0,0\n\n"
    "time,temperature_2m (°C),shortwave_radiation (W/m²)\n" + "".join(f"{s},1.5,0\n" for s in stamps),
    '"Datum","Standort","Parameter","Intervall","Einheit","Wert","Status"\n'
    + "".join(f'"{s}+0100","a","{p}","h1","x",0,"b"\n' for s in stamps for p in ("T", "StrGlo")),
    "STATIONS_ID;MESS_DATUM;QN_592;FD_LBERG;FG_LBERG;eor\n"
    + "".join(f"183;20210621{h:02}:33;1;0;0;eor\n" for h in range(24)),
    "time,t,g\n" + "".join(f"{s}Z,1.5,0\n" for s in stamps),
]
for n, text in enumerate(weather):
    seed("weather", f"format{n}", bytes([n]) + text.encode())
print(f"seeds in {here}")
