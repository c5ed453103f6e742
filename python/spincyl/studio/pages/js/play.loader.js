// Opens the page: unpacks the core, and the style, the page and the script.

const $ = id => document.getElementById(id);
const fail = why => {
  $("reason").textContent = why + " So this is a picture only; spincyl.view(motion) in Python writes a page that computes nothing and needs WebGL 2.";
  $("missing").hidden = false;
  for (const shown of document.querySelectorAll("header, main")) shown.hidden = true;
  document.documentElement.dataset.failed = why;
};
// seven bits in each character; one above 127 stands for a character that a page cannot contain, and the next
// one
function bytesOf(text) {
  const bytes = new Uint8Array(text.length * 7 >> 2), unfit = [0, 13, 60];
  let n = 0;
  for (let i = 0, held = 0, bits = 0; i < text.length; i++) {
    const c = text.charCodeAt(i);
    if (c < 128) { held = held << 7 | c; bits += 7; }
    else { held = held << 14 | unfit[(c >> 7) - 1] << 7 | c & 127; bits += 14; }
    for (; bits > 7; n++) { bits -= 8; bytes[n] = held >> bits; }
  }
  return bytes.subarray(0, n);
}
// the content of one piece of a text after the other; a piece is the length of its stream, that of its content, a checksum of
// the content (Adler-32), and the stream
function* unpacked(text) {
  try {
    const packed = bytesOf(text);
    for (let at = 0; ;) {
      const head = new DataView(packed.buffer, at, 12), [length, size, sum] = [0, 4, 8].map(i => head.getUint32(i));
      const content = expanded(packed.subarray(at + 12, at += 12 + length), size);
      if (sumOf(content) !== sum) throw Error();
      yield content;
    }
  } catch { throw Error("This page is incomplete or damaged."); }
}
function sumOf(bytes) {
  let plain = 1, weighted = 0;
  for (const byte of bytes) {
    plain = (plain + byte) % 65521;
    weighted = (weighted + plain) % 65521;
  }
  return weighted * 65536 + plain;
}
async function started(core) {
  try { return (await WebAssembly.instantiate(core, {})).instance.exports; }
  catch (e) { throw Error("This page needs WebAssembly, which this browser or the page around it does not allow (" + e.message + ")."); }
}
async function opened() {
  // a browser compiles the core while the rest is unpacked
  const pieces = unpacked($("packed").textContent), starting = started(joined(pieces.next().value));
  const [style, page, script] = new TextDecoder().decode(pieces.next().value).split("\0"), core = await starting;
  // inserts all visible parts at once, so that nothing moves
  document.head.append(Object.assign(document.createElement("style"), { textContent: style }));
  document.body.insertAdjacentHTML("afterbegin", page);
  document.querySelector("h1").textContent = document.title;
  window.spincyl = { core, dusk, given: JSON.parse($("given").textContent), fail };
  document.body.append(Object.assign(document.createElement("script"), { textContent: script }));
}
opened().catch(e => fail(e.message));
