// Opens the page: unpacks the core, the style, the page and the script.

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
// two byte strings from a text: a header has the lengths of the deflated stream and of the first string; the
// stream has a checksum
async function unpacked(text) {
  if (!window.DecompressionStream) throw Error("This page needs DecompressionStream, which this browser does not have.");
  try {
    const packed = bytesOf(text), head = new DataView(packed.buffer), end = 8 + head.getUint32(0), size = head.getUint32(4);
    const stream = new Blob([packed.subarray(8, end)]).stream().pipeThrough(new DecompressionStream("deflate"));
    const all = new Uint8Array(await new Response(stream).arrayBuffer());
    return [all.subarray(0, size), all.subarray(size)];
  } catch { throw Error("This page is incomplete or damaged."); }
}
async function started(core) {
  try { return (await WebAssembly.instantiate(core, {})).instance.exports; }
  catch (e) { throw Error("This page needs WebAssembly, which this browser or the page around it does not allow (" + e.message + ")."); }
}
async function opened() {
  const [packed, text] = await unpacked($("packed").textContent), core = await started(packed);
  const [style, page, script] = new TextDecoder().decode(text).split("\0");
  // inserts all visible parts at once, so that nothing moves
  document.head.append(Object.assign(document.createElement("style"), { textContent: style }));
  document.body.insertAdjacentHTML("afterbegin", page);
  document.querySelector("h1").textContent = document.title;
  window.spincyl = { core, dusk, given: JSON.parse($("given").textContent), fail };
  document.body.append(Object.assign(document.createElement("script"), { textContent: script }));
}
opened().catch(e => fail(e.message));
