"""What a study costs over its size: python3 benches/cost.py PROGRAM FIGURE.svg

Demo studies of several sizes go through ingest, solve, simulate and control, with one thing varied at a time: samples, designs,
windows, missions, threads. Prints a table in Markdown and draws the same numbers. Python has the packages of
tests/peers/requirements.txt.
"""

import pathlib
import re
import statistics
import subprocess
import sys
import tempfile
import time

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt

program = pathlib.Path(sys.argv[1]).resolve()
figure = pathlib.Path(sys.argv[2])
STAGES = ["ingest", "solve", "simulate", "control"]
REPEATS = 3
#: What is varied, over what; all else is as in the first column of each.
MISSIONS, DESIGNS, WINDOWS, THREADS = 96, 5, 17, 2
VARIED = {
    "missions": [24, 48, 96, 192],
    "designs": [1, 5, 10, 20],
    "windows": [1, 5, 17, 65],
    "threads": [1, 2],
}


def study_of(folder, missions, designs, windows):
    """A demo with its designs repeated under other names, and windows of equal steps up to ±2."""
    subprocess.run([program, "demo", folder, "--missions", str(missions), "--quiet"], check=True, capture_output=True)
    file = folder / "study.toml"
    text = file.read_text()
    step = 2.0 / max(windows - 1, 1)
    limits = "[1.0]" if windows == 1 else f"{{ from = 0.0, to = 2.0, step = {step} }}"
    # The windows of the study, those that are simulated and those that are driven.
    for line, value in [(r"\{.*", limits), (r"\[0\.0, .*", "[1.0]"), (r"\[0\.25, .*", "[1.0]")]:
        text, count = re.subn(rf"(?m)^pmv_limits = {line}$", f"pmv_limits = {value}", text)
        assert count == 1, f"the demo's study has one line of {line}"
    text = re.sub(r'(?ms)^#? ?\[designs\..*?(?=^\[(?!designs)|\Z)', "", text)
    kinds = [
        'heating = "ptc"',
        'heating = "ptc"\nradiant_heaters = true',
        'heating = "hp"',
        'heating = "hp"\nradiant_heaters = true',
        'heating = "hp"\nair_curtain = true',
    ]
    text += "".join(f'\n[designs."d{i}"]\n{kinds[i % 5]}\n' for i in range(designs))
    file.write_text(text)


def times(missions, designs, windows, threads):
    """Seconds of each stage, the median of some runs, each on an empty database; the samples."""
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch) / "study"
        study_of(folder, missions, designs, windows)
        took = {stage: [] for stage in STAGES}
        for repeat in range(REPEATS):
            database = folder / f"{repeat}.db"
            for stage in ["ingest", "shade", *STAGES[1:]]:
                begin = time.perf_counter()
                command = [program, stage, "--quiet", "--db", database, "--threads", str(threads)]
                done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
                assert done.returncode in (0, 1), done.stderr
                if stage in took:
                    took[stage].append(time.perf_counter() - begin)
        return {stage: statistics.median(seconds) for stage, seconds in took.items()}


def main():
    base = {"missions": MISSIONS, "designs": DESIGNS, "windows": WINDOWS, "threads": THREADS}
    known = {}
    drawn, axes = plt.subplots(1, len(VARIED), figsize=(11, 2.6), constrained_layout=True)
    print("| varied | | " + " | ".join(f"{stage} in s" for stage in STAGES) + " |")
    print("|---|---:|" + "---:|" * len(STAGES))
    for axis, (name, values) in zip(axes, VARIED.items()):
        rows = []
        for value in values:
            size = tuple((base | {name: value}).values())
            if size not in known:
                known[size] = times(*size)
            rows.append(known[size])
            print(f"| {name} | {value} | " + " | ".join(f"{rows[-1][stage]:.3g}" for stage in STAGES) + " |", flush=True)
        for stage, marker in zip(STAGES, "o^sD"):
            axis.plot(values, [row[stage] for row in rows], marker=marker, markersize=4, label=stage)
        axis.set(xlabel=name, xscale="log", yscale="log", xticks=values, xticklabels=values)
        axis.set_yticks([0.25, 0.5, 1, 2, 4], ["0.25", "0.5", "1", "2", "4"])
        axis.minorticks_off()
        axis.grid(alpha=0.3)
    axes[0].set_ylabel("time in s")
    axes[0].legend(fontsize=7, frameon=False)
    drawn.savefig(figure, metadata={"Date": None})


plt.rcParams["svg.hashsalt"] = "busclimate"
plt.rcParams["font.size"] = 8
main()
