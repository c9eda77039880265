// SPDX-License-Identifier: BSD-3-Clause
//
// The numbers of the page: unpacked, and put together again from the planes of bytes that apps/cli/view/view_page.cpp made.

const TYPES = { f4: Float32Array, f8: Float64Array, u4: Uint32Array, i1: Int8Array };

function bytesOf(base64) {
  const clean = base64.trim();
  const padding = clean.endsWith('==') ? 2 : clean.endsWith('=') ? 1 : 0;
  const bytes = new Uint8Array((clean.length / 4) * 3 - padding);
  const PIECE = 1 << 20; // a multiple of 4
  for (let at = 0, to = 0; at < clean.length; at += PIECE) {
    const text = atob(clean.slice(at, at + PIECE));
    for (let i = 0; i < text.length; ++i) bytes[to++] = text.charCodeAt(i);
  }
  return bytes;
}

/** The bytes that base64 text of gzip stands for. */
export async function unpack(base64) {
  if (typeof DecompressionStream === 'undefined')
    throw new Error('this browser cannot unpack the page (no DecompressionStream); expected Chrome or Edge 80, ' +
      'Safari 16.4, Firefox 113, or later');
  const stream = new Blob([bytesOf(base64)]).stream().pipeThrough(new DecompressionStream('gzip'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** An array of rows x width numbers, row = item. */
export function arrayOf(bytes, { type, rows, width, from }) {
  const Type = TYPES[type];
  const size = Type.BYTES_PER_ELEMENT;
  const result = new Type(rows * width);
  const raw = new Uint8Array(result.buffer);
  for (let k = 0; k < width; ++k)
    for (let b = 0; b < size; ++b) {
      let at = from + (k * size + b) * rows;
      for (let i = 0, to = k * size + b; i < rows; ++i, to += width * size) raw[to] = bytes[at++];
    }
  return result;
}

const unzigzag = (code) => (code >>> 1) ^ -(code & 1);

/** Vertex numbers of simplices, rows x width. */
export function simplicesOf(bytes, description) {
  const corners = arrayOf(bytes, description);
  const { rows, width } = description;
  let before = 0;
  for (let i = 0; i < rows; ++i) {
    before = (before + unzigzag(corners[i * width])) >>> 0;
    corners[i * width] = before;
    for (let k = 1; k < width; ++k) corners[i * width + k] = (before + unzigzag(corners[i * width + k])) >>> 0;
  }
  return corners;
}
