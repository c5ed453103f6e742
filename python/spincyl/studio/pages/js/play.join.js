// Joins the code of a core, which web/build.py splits into streams of like numbers, since these compress better. The data
// are the length of the core, those of the streams, and the streams.

function joined(data) {
  const [head, forms, codes, short, middle, long, offsets, gets, sets, floats, tail] = Array(11).keys();
  const view = new DataView(data.buffer, data.byteOffset), core = new Uint8Array(view.getUint32(0));
  const parts = [], at = Array(11).fill(0);
  for (let from = 48; parts.length < 11;) parts.push(data.subarray(from, from += view.getUint32(4 + 4 * parts.length)));
  let n = 0;
  const bytes = (part, count) => {
    core.set(parts[part].subarray(at[part], at[part] += count), n);
    n += count;
  };
  const byte = part => core[n++] = parts[part][at[part]++];
  // a number of any length
  const number = part => {
    let found = 0;
    for (let shift = 0; ; shift += 7) {
      const next = byte(part);
      found |= (next & 127) << shift;
      if (next < 128) return found;
    }
  };
  const numbers = (part, count) => { while (count-- > 0) number(part); };
  const memory = () => { number(codes); number(offsets); };
  const simd = code => {
    if (code === 12 || code === 13) bytes(floats, 16);
    else if (code < 12 || code > 83 && code < 94) memory();
    if (code > 20 && code < 35 || code > 83 && code < 92) number(codes);
  };
  // log2 of the bytes that a load or store moves, which is its alignment, but for few
  const aligned = "23230011001122232301012";
  // the code of the next instruction: loads and stores that are aligned otherwise have codes of their own here, and so have
  // integers of two bytes and of more
  const instruction = () => {
    const code = byte(codes), other = code > 224 && code < 248;
    if (code > 248 && code < 251) { core[n - 1] = 65; number(code < 250 ? middle : long); return 1; }
    if (other) core[n - 1] -= 185;
    if (other || code > 39 && code < 63) {
      if (other) number(codes); else core[n++] = aligned[code - 40];
      number(offsets);
      return 1;
    }
    return code;
  };
  // branches, calls, globals, the size of the memory and integers of 64 bits
  const plain = [12, 13, 16, 35, 36, 63, 64, 66];
  // the operands of one instruction; returns by how much deeper the next one is nested
  const operands = code => {
    if (code === 11) return -1;
    if (code > 1 && code < 5) { number(codes); return 1; }
    if (plain.includes(code)) number(codes);
    else if (code === 14) numbers(codes, number(codes) + 1);
    else if (code === 17) numbers(codes, 2);
    else if (code === 32) number(gets);
    else if (code === 33 || code === 34) number(sets);
    else if (code === 65) number(short);
    else if (code === 67 || code === 68) bytes(floats, code === 67 ? 4 : 8);
    else if (code === 252) numbers(codes, [2, 1, 2, 1][number(codes) - 8] || 0);
    else if (code === 253) simd(number(codes));
    return 0;
  };
  bytes(head, parts[head].length);
  for (let left = number(forms); left--;) {
    const start = n;
    numbers(forms, 2 * number(forms));
    for (let depth = 1; depth;) depth += operands(instruction());
    // the length of a function stands before it
    const size = [];
    for (let rest = n - start; rest || !size.length; rest >>>= 7) size.push(rest & 127 | (rest > 127 ? 128 : 0));
    core.copyWithin(start + size.length, start, n);
    core.set(size, start);
    n += size.length;
  }
  bytes(tail, parts[tail].length);
  return core;
}
