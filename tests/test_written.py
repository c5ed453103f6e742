"""Written files: complete or unchanged, in the given place, with permissions as from `open`."""

import ast
import errno
import json
import os
import re
import socket
import stat
import subprocess
import sys
import threading
from pathlib import Path

import pytest
from saving import JOBS, filmed, scene, shown

import spincyl as sc
from spincyl._input.files import writing_whole

HERE = Path(__file__).parent
PARTS = ".spincyl-*"


def script(*words, **how):
    """Run a process with the imports of this one."""
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(HERE), *sys.path])}
    return subprocess.run([sys.executable, *words], env=environment, capture_output=True, text=True, **how)


# failures


@pytest.fixture(scope="module")
def cramped(tmp_path_factory):
    """Folders with older files, and the errors of saving to them without room: saves that fail or die."""
    folders = [tmp_path_factory.mktemp(name) for name in ("fails", "dies")]
    for folder in folders:
        for name in JOBS:
            (folder / name).write_text(f"an older {name}")
    ended = script(str(HERE / "saving.py"), *folders)
    assert not ended.returncode, ended.stderr
    return list(zip(folders, json.loads(ended.stdout), strict=True))


@pytest.mark.parametrize("name", JOBS)
def test_a_save_that_fails_leaves_what_was_there_and_says_of_which_file(cramped, name):
    folder, told = cramped[0]
    assert (folder / name).read_text() == f"an older {name}"
    assert name.split(".")[0] in told[name] and "spincyl-" not in told[name], told[name]
    assert sorted(p.name for p in folder.iterdir()) == sorted(JOBS)


@pytest.mark.parametrize("name", JOBS)
def test_a_process_that_is_killed_while_it_saves_leaves_what_was_there(cramped, name):
    folder, told = cramped[1]
    # for a silent film the signal kills ffmpeg, which writes the file; a film with sound dies as its sound is written
    assert told[name].startswith(
        "silent.mp4: ffmpeg: ended with code -" if name == "silent.mp4" else "signal "
    )
    assert told[name] != "signal 0" and (folder / name).read_text() == f"an older {name}"


def test_a_save_that_is_interrupted_leaves_what_was_there_and_nothing_else(tmp_path, monkeypatch):
    written = Path.write_bytes

    def interrupted(path, data):
        written(path, data[:100])
        raise KeyboardInterrupt

    monkeypatch.setattr(Path, "write_bytes", interrupted)
    path = tmp_path / "spin.html"
    path.write_text("an older page")
    with pytest.raises(KeyboardInterrupt):
        shown(path)
    assert path.read_text() == "an older page" and os.listdir(tmp_path) == ["spin.html"]


def test_of_a_scene_both_files_are_new_or_none(tmp_path):
    (tmp_path / "a.json").write_text("an older scene")
    (tmp_path / "a.xml").mkdir()
    with pytest.raises(IsADirectoryError, match=re.escape(str(tmp_path / "a.xml"))):
        scene(tmp_path / "a")
    assert (tmp_path / "a.json").read_text() == "an older scene"
    assert sorted(os.listdir(tmp_path)) == ["a.json", "a.xml"]


# places


def files(folder):
    return sorted(str(p.relative_to(folder)) for p in Path(folder).rglob("*") if p.is_file())


@pytest.mark.parametrize(
    "name",
    [
        "tee:[f=mp4]zz.mp4",
        "-y.mp4",
        "12:30.mp4",
        "file:x.mp4",
        "pipe:1.mp4",
        "concat:a|b.mp4",
        "data:,.mp4",
        "a%03d.mp4",
        "~.mp4",
        " a\n'b' .MP4",
        "$(touch x).mp4",
        251 * "a" + ".mp4",
        "tee:[f=gif]zz.gif",
    ],
)
def test_the_name_of_a_film_is_that_of_a_file_and_nothing_else(tmp_path, monkeypatch, name):
    monkeypatch.chdir(tmp_path)
    assert filmed(name) == Path(name)
    assert files(tmp_path) == [name]
    head = Path(name).read_bytes()[:8]
    assert head[4:] == b"ftyp" or head.startswith(b"GIF8")


def test_a_film_is_sent_nowhere(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with socket.create_server(("127.0.0.1", 0)) as server:
        server.setblocking(False)
        name = f"http:/127.0.0.1:{server.getsockname()[1]}/x.mp4"
        with pytest.raises(FileNotFoundError, match=re.escape(name)):
            filmed(name)
        Path(name).parent.mkdir(parents=True)
        filmed(name)
        assert files(tmp_path) == [name]
        with pytest.raises(BlockingIOError):
            server.accept()


@pytest.mark.parametrize("kind", JOBS)
def test_every_kind_of_file_has_the_name_that_it_was_given(tmp_path, monkeypatch, kind):
    (tmp_path / "home").mkdir()
    (tmp_path / "here" / "~").mkdir(parents=True)
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    monkeypatch.chdir(tmp_path / "here")
    suffix = Path(kind).suffix
    names = [f"~/in{suffix}", f"a::b{suffix}", f"-y{suffix}", f"http:c{suffix.upper()}"]
    for name in names:
        JOBS[kind](name)
    assert files(".") == sorted(names) and not files("../home")


# permissions and links as with `open`


def test_a_new_file_has_the_permissions_of_new_files_and_a_later_one_those_that_it_had(tmp_path):
    path = tmp_path / "spin.html"
    before = os.umask(0o027)
    try:
        shown(path)
        assert stat.S_IMODE(path.stat().st_mode) == 0o640
        path.chmod(0o604)
        shown(path)
        assert stat.S_IMODE(path.stat().st_mode) == 0o604
    finally:
        os.umask(before)


def test_while_it_is_made_nobody_reads_what_replaces_a_secret(tmp_path):
    path = tmp_path / "secret.csv"
    path.write_text("secret")
    path.chmod(0o600)
    with writing_whole(path) as part:
        assert stat.S_IMODE(part.stat().st_mode) == 0o600 and part.parent == tmp_path


def test_links_lead_to_what_is_written(tmp_path):
    (tmp_path / "there").mkdir()
    target, link, second = tmp_path / "there" / "spin", tmp_path / "link.html", tmp_path / "second.html"
    link.symlink_to("there/spin")
    second.symlink_to(link)
    for old in (None, "an older page"):  # the target of a link may not exist yet
        if old is not None:
            target.write_text(old)
        assert shown(second) == second
        assert link.is_symlink() and second.is_symlink() and target.read_bytes().startswith(b"<!DOCTYPE")
        assert files(tmp_path / "there") == ["spin"]
    round_ = tmp_path / "round.html"
    round_.symlink_to(round_)
    with pytest.raises(OSError, match=re.escape(str(round_))) as told:
        shown(round_)
    assert told.value.errno == errno.ELOOP and round_.is_symlink()


@pytest.mark.parametrize(
    ("place", "kind"),
    [
        ("folder.html", IsADirectoryError),
        ("nowhere/spin.html", FileNotFoundError),
        ("file/spin.html", NotADirectoryError),
        ("lost.html", FileNotFoundError),
    ],
)
def test_where_no_file_can_be_it_is_said_by_name(tmp_path, place, kind):
    (tmp_path / "folder.html").mkdir()
    (tmp_path / "file").touch()
    (tmp_path / "lost.html").symlink_to(tmp_path / "nowhere" / "spin.html")
    before = sorted(tmp_path.iterdir())
    with pytest.raises(kind) as told:
        shown(tmp_path / place)
    assert told.value.filename == str(tmp_path / place) and sorted(tmp_path.iterdir()) == before


def test_a_pipe_is_given_the_whole_file(tmp_path):
    os.mkfifo(tmp_path / "pipe.glb")
    read = []
    reader = threading.Thread(target=lambda: read.append((tmp_path / "pipe.glb").read_bytes()), daemon=True)
    reader.start()
    shown(tmp_path / "pipe.glb")
    reader.join(60)
    assert read == [shown(tmp_path / "spin.glb").read_bytes()]
    assert stat.S_ISFIFO((tmp_path / "pipe.glb").stat().st_mode)
    assert sorted(os.listdir(tmp_path)) == ["pipe.glb", "spin.glb"]


SHOW = "import saving; saving.shown('out.html'); print('after')"


def test_what_goes_to_the_output_goes_where_the_output_goes(tmp_path):
    (tmp_path / "out.html").symlink_to("/dev/stdout")
    expected = shown(tmp_path / "spin.html").read_text("utf-8")
    assert script("-c", SHOW, cwd=tmp_path).stdout == f"{expected}after\n"
    with (tmp_path / "all.txt").open("ab") as file:
        words = [sys.executable, "-c", SHOW]
        environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(HERE), *sys.path])}
        subprocess.run(words, env=environment, cwd=tmp_path, stdout=file, check=True)
    assert (tmp_path / "all.txt").read_text("utf-8") == f"{expected}after\n"
    assert files(tmp_path) == ["all.txt", "out.html", "spin.html"]


FORBIDDEN = """
import os
from spincyl._input.files import writing_whole
if not os.getuid():
    os.setgid(65534), os.setuid(65534)
os.close(os.open("../mine.html", os.O_CREAT, 0o444))
for name in ("old.html", "new.html", "fixed.html", "../theirs.html", "../mine.html", "../full.html"):
    try:
        with writing_whole(name) as part:
            part.write_text("newer")
        print("saved")
    except OSError as e:
        print(e.strerror, e.filename)
"""


def test_what_may_be_written_to_but_not_replaced_is_written_to(tmp_path):
    folder = tmp_path / "closed"
    folder.mkdir()
    for name, mode in (("old.html", 0o666), ("fixed.html", 0o444)):
        (folder / name).write_text("older")
        (folder / name).chmod(mode)
    theirs = tmp_path / "theirs.html"  # replaceable, but a replacement would not have its owner
    theirs.write_text("older")
    theirs.chmod(0o666)
    before = theirs.stat()
    (tmp_path / "full.html").symlink_to("/dev/full")
    above = {place: place.stat().st_mode for place in (folder, tmp_path, *tmp_path.parents[:2])}
    for place in above:
        place.chmod({folder: 0o555, tmp_path: 0o777}.get(place, 0o755))
    try:
        ended = script("-c", FORBIDDEN, cwd=folder)
    finally:
        for place, mode in above.items():
            place.chmod(mode)
    said = ["saved", "Permission denied new.html", "Permission denied fixed.html", "saved"]
    said += ["Permission denied ../mine.html", "No space left on device ../full.html"]
    assert ended.stdout.splitlines() == said, ended.stderr
    assert files(folder) == ["fixed.html", "old.html"]
    assert [(folder / name).read_text() for name in files(folder)] == ["older", "newer"]
    assert theirs.read_text() == "newer" and not list(tmp_path.glob(PARTS))
    after = theirs.stat()
    assert (after.st_mode, after.st_uid) == (before.st_mode, before.st_uid)


@pytest.mark.skipif(os.getuid() != 0, reason="only root has files of others")
def test_a_file_of_somebody_else_stays_theirs(tmp_path):
    path = tmp_path / "spin.html"
    path.write_text("older")
    os.chown(path, 65534, 65534)
    path.chmod(0o640)
    shown(path)
    found = path.stat()
    assert (found.st_uid, found.st_gid, stat.S_IMODE(found.st_mode)) == (65534, 65534, 0o640)


# no other way of writing

SOURCES = sorted(Path(sc.__file__).parent.rglob("*.py"))
WRITERS = {*"write_text write_bytes savefig savetxt savez_compressed savez to_netcdf to_csv".split()}
#: Exceptions: writing to a stream, to memory, or to a new place.
ALLOWED = {
    ("cli/_files.py", "np.savetxt(file, table, **how)"),
    ("_input/files.py", "path.open('ab')"),
    ("_input/files.py", "path.open('wb')"),
    ("studio/frames.py", "stage.figure.savefig(file, format=kind)"),
    ("cli/_output.py", "path.open('ab')"),
    ("studio/plot/_style.py", "figure.savefig(made, format=path.suffix[1:].lower(), dpi=dpi)"),
    ("sweep/_save.py", "(store.marks / 'lock').open('ab')"),
    (
        "studio/sound.py",
        "wave.open(str(path), 'wb')",
    ),  # the part of a sound, or a folder that goes with a film
}


def writing(tree):
    """The calls of a module that write a file, except to the part of a `with writing_whole(...)`."""
    for call in (x for x in ast.walk(tree) if isinstance(x, ast.Call)):
        name = getattr(call.func, "attr", getattr(call.func, "id", ""))
        words = [x.value for x in call.args if isinstance(x, ast.Constant) and isinstance(x.value, str)]
        opens = name == "open" and any(set(word) & set("wax+") and len(word) < 4 for word in words)
        text = ast.unparse(call)
        if (name in WRITERS or opens) and not re.match(r"part\.|[\w.]+\((str\()?part\b", text):
            yield text


def test_only_one_place_writes_files():
    root = Path(sc.__file__).parent
    found = {
        (p.relative_to(root).as_posix(), x) for p in SOURCES for x in writing(ast.parse(p.read_text("utf-8")))
    }
    assert found == ALLOWED


@pytest.mark.parametrize(
    "line", ["path.write_text(x)", "open(path, 'w')", "path.open('r+b')", "figure.savefig(path)"]
)
def test_a_line_that_writes_a_file_is_known(line):
    assert list(writing(ast.parse(line)))
