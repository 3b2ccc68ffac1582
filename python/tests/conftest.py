"""A study that the program has made, and the package has run."""

import os
import subprocess
from pathlib import Path

import pytest

import busclimate as bc

PROGRAM = os.environ.get("BUSCLIMATE_PROGRAM")


def demo(folder: Path, missions: int) -> bc.Study:
    """A demo with two comfort windows, run."""
    if PROGRAM is None:
        pytest.skip("BUSCLIMATE_PROGRAM names no program")
    subprocess.run([PROGRAM, "demo", folder, "--missions", str(missions), "--quiet"], check=True)
    text = (folder / "study.toml").read_text()
    text = text.replace("{ from = 0.0, to = 2.0, step = 0.125 }", "[0.5, 1.0]")
    (folder / "study.toml").write_text(text.replace("pmv_limits = [0.0, 0.5, 1.0, 1.5, 2.0]", "pmv_limits = [1.0]"))
    return bc.Study.open(folder)


@pytest.fixture(scope="session")
def study(tmp_path_factory: pytest.TempPathFactory) -> bc.Study:
    """A small one."""
    opened = demo(tmp_path_factory.mktemp("demo"), 24)
    assert opened.run()[0].startswith("Within PMV ±1")
    return opened
