// LZMA, as Python's lzma writes it: the raw stream with lc = 3, lp = 0, pb = 0 and its end marker.
// Each bit is as likely as those before it in the same place were: `chances` are shares of 2048 that it is a nought.

// where the chances of each kind begin: 12 states each, then trees of 3 to 8 bits; a length has 2 + 8 + 8 + 256
const MATCH = 0, AGAIN = 12, OLDER = 24, OLDER2 = 36, OLDER3 = 48, LONGER = 60;
const SLOT = 72, NEAR = 328, ALIGN = 443, LENGTH = 459, LENGTH_AGAIN = 733, LITERAL = 1007, ALL = LITERAL + 8 * 768;

function unpacked(from, size) {
  const into = new Uint8Array(size), chances = new Uint16Array(ALL).fill(1024);
  // the interval that is left, and where in it the number lies that the stream writes
  const coder = new Uint32Array([-1, from[1] << 24 | from[2] << 16 | from[3] << 8 | from[4]]);
  let at = 5;
  // a number of so many bits, the highest first; what has bits to be guided by has other chances while they agree
  const tree = (base, bits, guide = 0, guided = 0) => {
    let width = coder[0], code = coder[1], found = 1;
    for (const end = 1 << bits; found < end;) {
      guide <<= 1;
      const expected = guide & guided, i = base + guided + expected + found, chance = chances[i];
      if (width < 0x1000000) { width = width << 8 >>> 0; code = (code << 8 | from[at++]) >>> 0; }
      const bound = (width >>> 11) * chance;
      if (code < bound) { width = bound; chances[i] = chance + (2048 - chance >> 5); found <<= 1; guided &= ~expected; }
      else { width -= bound; code -= bound; chances[i] = chance - (chance >> 5); found = found << 1 | 1; guided &= expected; }
    }
    coder[0] = width; coder[1] = code;
    return found - (1 << bits);
  };
  const bit = i => tree(i - 1, 1);
  // the lowest bit first
  const reversed = (base, bits) => {
    let found = 0;
    for (let rest = tree(base, bits); bits; bits--, rest >>= 1) found = found << 1 | rest & 1;
    return found;
  };
  // bits of which nothing is known
  const even = bits => {
    let found = 0;
    for (; bits; bits--) {
      if (coder[0] < 0x1000000) { coder[0] <<= 8; coder[1] = coder[1] << 8 | from[at++]; }
      coder[0] >>>= 1;
      const one = +(coder[1] >= coder[0]);
      coder[1] -= one * coder[0];
      found = found << 1 | one;
    }
    return found;
  };
  const lengthOf = base => !bit(base) ? 2 + tree(base + 2, 3) : !bit(base + 1) ? 10 + tree(base + 10, 3) : 18 + tree(base + 18, 8);
  const torn = () => Error("its packed part is not whole");

  // `back`: how far before the last byte the last match begins, and the three before it; `state`: what came last
  const back = [0, 0, 0, 0];
  let n = 0, state = 0;
  for (;;) {
    if (n > size || at > from.length) throw torn();
    if (!bit(MATCH + state)) {
      const base = LITERAL + 768 * (n && into[n - 1] >> 5);
      into[n] = state < 7 ? tree(base, 8) : tree(base, 8, into[n - back[0] - 1], 256);
      n++;
      state = state < 4 ? 0 : state < 10 ? state - 3 : state - 6;
      continue;
    }
    const first = state < 7;
    let length = 1, far, which = 3;
    if (!bit(AGAIN + state)) {
      length = lengthOf(LENGTH);
      state = first ? 7 : 10;
      const slot = tree(SLOT + 64 * Math.min(length - 2, 3), 6), bits = (slot >> 1) - 1;
      far = slot < 4 ? slot : (2 | slot & 1) << bits;
      if (slot > 13) far += (even(bits - 4) << 4) + reversed(ALIGN, 4);
      else if (slot > 3) far += reversed(NEAR + far - slot, bits);
      if (far === -1) break; // the end marker
    } else {
      which = !bit(OLDER + state) ? 0 : !bit(OLDER2 + state) ? 1 : 2 + bit(OLDER3 + state);
      far = back[which];
      const longer = which || bit(LONGER + state);
      if (longer) length = lengthOf(LENGTH_AGAIN);
      state = !first ? 11 : longer ? 8 : 9;
    }
    for (; which; which--) back[which] = back[which - 1];
    back[0] = far;
    if (far >>> 0 >= n) throw torn();
    for (; length; length--, n++) into[n] = into[n - far - 1];
  }
  // the coder of a whole stream ends with nothing left, and so this is a checksum, too
  if (n !== size || coder[1]) throw torn();
  return into;
}
