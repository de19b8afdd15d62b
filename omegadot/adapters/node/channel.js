// The frames of docs/worker-protocol.md: requests from standard input, answers to standard output.
'use strict';
const fs = require('fs');

// An array of an answer. shape: of numbers, flat: as many numbers, the last axis fastest.
class Table {
  constructor(shape, flat) {
    this.shape = shape;
    this.flat = Float64Array.from(flat);
  }
}

// What an engine cannot do: it is answered as unsupported, with this reason.
class Unsupported extends Error {}

// Exactly so many bytes of standard input; at its end, leave.
function read(count) {
  const buffer = Buffer.alloc(count);
  for (let at = 0; at < count;) {
    const got = fs.readSync(0, buffer, at, count - at);
    if (!got) process.exit(0);
    at += got;
  }
  return buffer;
}

function write(buffer) {
  for (let rest = buffer; rest.length;) rest = rest.subarray(fs.writeSync(1, rest));
}

// The next request. Its arrays become flat lists, a single number a number.
function receive() {
  const header = JSON.parse(read(Number(read(8).readBigUInt64BE())));
  const arrays = header.shapes.map((shape) => {
    const bytes = read(8 * shape.reduce((a, b) => a * b, 1));
    const flat = Array.from({ length: bytes.length / 8 }, (_, i) => bytes.readDoubleLE(8 * i));
    return shape.length ? flat : flat[0];
  });
  const filled = (key, value) => (value && '$array' in Object(value) ? arrays[value.$array] : value);
  return JSON.parse(JSON.stringify(header.body), filled);
}

function send(answer) {
  const tables = [];
  const text = JSON.stringify(answer, (key, value) => {
    if (!(value instanceof Table)) return value;
    return { $array: tables.push(value) - 1 };
  });
  const shapes = JSON.stringify(tables.map((table) => table.shape));
  const header = Buffer.from(`{"body":${text},"shapes":${shapes}}`);
  const length = Buffer.alloc(8);
  length.writeBigUInt64BE(BigInt(header.length));
  write(Buffer.concat([length, header, ...tables.map(bytesOf)]));
}

function bytesOf(table) {
  const bytes = Buffer.alloc(8 * table.flat.length);
  table.flat.forEach((value, i) => bytes.writeDoubleLE(value, 8 * i));
  return bytes;
}

module.exports = { Table, Unsupported, receive, send };
