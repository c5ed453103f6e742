// Decodes LZMA with lc = 1 and lp = pb = 0, after the specification of the format, which is in the public domain.
// Damage is not noticed here, except an early end; the checksum of the result tells.

function expanded(data, size) {
  // chances of a 0 in 2048ths; first those of each of 12 states: a match, an old distance, which one (3), of one byte
  const slots = 72, near = 328, align = 456, fresh = 472, again = 746, literals = 1020;
  const chances = new Uint16Array(literals + 2 * 768).fill(1024), out = new Uint8Array(size), old = new Uint32Array(4);
  let at = 5, n = 0, state = 0;
  // range and code, in an array of integers since a number above 2^30 would be an object
  const now = Uint32Array.of(-1, new DataView(data.buffer, data.byteOffset).getUint32(1));
  const next = () => {
    if (now[0] >= 2 ** 24) return;
    if (at === data.length) throw Error();
    now[0] <<= 8;
    now[1] = now[1] << 8 | data[at++];
  };
  const bit = i => {
    const chance = chances[i], bound = Math.imul(now[0] >>> 11, chance) >>> 0, one = now[1] >= bound;
    if (one) { now[0] -= bound; now[1] -= bound; chances[i] -= chance >> 5; }
    else { now[0] = bound; chances[i] += 2048 - chance >> 5; }
    next();
    return one ? 1 : 0;
  };
  const direct = () => {
    now[0] >>>= 1;
    const one = now[1] >= now[0];
    if (one) now[1] -= now[0];
    next();
    return one ? 1 : 0;
  };
  const tree = (i, end) => {
    let found = 1;
    while (found < end) found = found << 1 | bit(i + found);
    return found - end;
  };
  const reversed = (i, bits) => {
    let found = 0;
    for (let k = 0, node = 1; k < bits; k++) {
      const one = bit(i + node);
      node = node << 1 | one;
      found |= one << k;
    }
    return found;
  };
  const length = i => bit(i) ? bit(i + 1) ? 18 + tree(i + 18, 256) : 10 + tree(i + 10, 8) : 2 + tree(i + 2, 8);
  const distance = slot => {
    if (slot < 4) return slot;
    const bits = (slot >> 1) - 1;
    let found = (2 | slot & 1) << bits;
    if (slot < 14) return found + reversed(near + found - slot, bits);
    for (let k = bits; k > 4;) found += direct() << --k;
    return found + reversed(align, 4);
  };
  const literal = () => {
    const i = literals + 768 * (out[n - 1] >> 7);
    let found = 1;
    for (let other = out[n - old[0] - 1], same = state > 6; same && found < 256; other <<= 1) {
      const one = bit(i + 256 + (other << 1 & 256) + found);
      found = found << 1 | one;
      same = one === (other >> 7 & 1);
    }
    while (found < 256) found = found << 1 | bit(i + found);
    out[n++] = found;
    state -= state < 4 ? state : state < 10 ? 3 : 6;
  };
  while (n < size) {
    if (!bit(state)) { literal(); continue; }
    const low = state < 7;
    let many = 1;
    if (!bit(12 + state)) {
      many = length(fresh);
      old.copyWithin(1, 0, 3);
      old[0] = distance(tree(slots + 64 * Math.min(many - 2, 3), 64));
      state = low ? 7 : 10;
    } else {
      const which = bit(24 + state) ? bit(36 + state) ? 2 + bit(48 + state) : 1 : 0, last = old[which];
      if (which || bit(60 + state)) { many = length(again); state = low ? 8 : 11; }
      else state = low ? 9 : 11;
      old.copyWithin(1, 0, which);
      old[0] = last;
    }
    for (let from = n - old[0] - 1; many--;) out[n++] = out[from++];
  }
  return out;
}
