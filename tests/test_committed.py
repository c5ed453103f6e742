"""What is committed stays small: a clone should not carry build outputs for ever."""

import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
#: The history before has 120 MB of wheels. What came since, and whatever the present tree has, is checked.
SINCE = "2026-11-27T00:00:00Z"
#: The largest picture of the docs has 480 kB.
MOST_OF_A_FILE = 640_000
#: The present tree has 13 MB.
MOST_IN_ALL = 21_000_000


def git(*words, **how):
    return subprocess.run(["git", *words], cwd=ROOT, check=True, capture_output=True, text=True, **how).stdout


def sizes(blobs):
    """The size in bytes of every blob, a submodule or an absent one left out."""
    told = git("cat-file", "--batch-check=%(objecttype) %(objectname) %(objectsize)", input="\n".join(blobs))
    rows = [line.split() for line in told.splitlines()]
    return {row[1]: int(row[2]) for row in rows if row[0] == "blob"}


@pytest.fixture(scope="module", autouse=True)
def repository():
    if not shutil.which("git") or not (ROOT / ".git").exists():
        pytest.skip("no git repository: the sources were not cloned")
    if subprocess.run(["git", "status"], cwd=ROOT, capture_output=True).returncode:
        pytest.skip("git refuses this folder, as it does where it belongs to somebody else")


def test_no_large_file_is_in_the_tree_nor_came_into_the_history():
    now = {}
    for line in git("ls-files", "--stage", "-z").split("\0")[:-1]:
        words, path = line.split("\t")
        now[words.split()[1]] = path
    came = {}
    told = git("log", f"--since={SINCE}", "--raw", "--no-abbrev", "--no-renames", "-m", "--format=")
    for line in filter(None, told.splitlines()):
        words, path = line.split("\t")
        came[words.split()[3]] = path
    paths = came | now
    large = {paths[blob]: size for blob, size in sizes(paths).items() if size > MOST_OF_A_FILE}
    assert not large, f"more than {MOST_OF_A_FILE} bytes: {large}"


def test_the_tree_is_small_as_a_whole():
    blobs = [line.split()[1] for line in git("ls-files", "--stage").splitlines()]
    assert len(blobs) > 500
    assert sum(sizes(blobs).values()) < MOST_IN_ALL
