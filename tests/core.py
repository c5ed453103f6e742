"""The core of the live page, called as the page calls it: by node, or by the browser of the page tests."""

import atexit
import base64
import functools
import json
import lzma
import shutil
import struct
import subprocess

import browser
import numpy as np

from spincyl.studio.pages.joined import text

# numbers are sent as bytes in both directions, since JSON has no infinity
ASK = """async (core, questions) => {
  JOINED
  const bytes = text => Uint8Array.from(atob(text), c => c.charCodeAt(0));
  const text = bytes => { let all = ""; for (const b of bytes) all += String.fromCharCode(b); return btoa(all); };
  const { exports: x } = (await WebAssembly.instantiate(joined(bytes(core)), {})).instance;
  return questions.map(([name, given]) => {
    const numbers = [...new Float64Array(bytes(given).buffer)];
    const code = x[name](...numbers);
    const view = (at, count) => text(new Uint8Array(x.memory.buffer, at, count));
    const map = name === "map" && !code ? view(x.codes(), numbers[0] * numbers[1]) : "";
    return [code, view(x.out(), 8 * x.len()), map, view(x.words(), x.words_len())];
  });
}""".replace("JOINED", text("play.join.js"))
# answers each line of input by a line
NODE = """(async () => {
  for await (const line of require("readline").createInterface({ input: process.stdin })) {
    const { core, questions } = JSON.parse(line);
    process.stdout.write(JSON.stringify(await (%s)(core, questions)) + "\\n");
  }
})();"""


class Answer:
    """A code, numbers, the region codes of a map, and the text of a refusal."""

    def __init__(self, code, out, codes, words):
        self.code = code
        self.out = np.frombuffer(base64.b64decode(out))
        self.codes = np.frombuffer(base64.b64decode(codes), np.uint8)
        self.words = base64.b64decode(words).decode().split("\n")


@functools.cache
def node():
    """A node process for all questions, since starting one takes longer than most answers."""
    pipe = subprocess.PIPE
    started = subprocess.Popen(["node", "-e", NODE % ASK], stdin=pipe, stdout=pipe, stderr=pipe, text=True)
    atexit.register(lambda: (started.stdin.close(), started.wait()))
    return started


def ask(packed, questions):
    """The answers of a packed core to a list of (name, numbers)."""
    core = base64.b64encode(lzma.decompress(packed)).decode()
    given = [
        (name, base64.b64encode(struct.pack(f"{len(x)}d", *map(float, x))).decode()) for name, x in questions
    ]
    if shutil.which("node"):
        process = node()
        print(json.dumps({"core": core, "questions": given}), file=process.stdin, flush=True)
        line = process.stdout.readline()
        if not line:  # a trap of the core ends the process
            node.cache_clear()
            raise AssertionError(process.stderr.read())
        return [Answer(*answer) for answer in json.loads(line)]
    from playwright.sync_api import sync_playwright

    with sync_playwright() as p:
        running = p.chromium.launch(executable_path=browser.executable(), args=browser.FLAGS)
        found = running.new_page().evaluate(f"([core, questions]) => ({ASK})(core, questions)", [core, given])
        running.close()
    return [Answer(*answer) for answer in found]


def runs():
    """Whether this machine can run WebAssembly."""
    return bool(shutil.which("node") or browser.find())
