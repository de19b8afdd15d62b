// A toy engine in JavaScript: a free body, stepped by semi-implicit Euler.
'use strict';
const fs = require('fs');
console.log = console.error; // standard output is for answers alone

const DESCRIPTION = {
  name: 'toyjs', version: '1.0', features: ['free', 'gravity', 'full_inertia', 'forward_dynamics'],
  integrators: [{
    name: 'euler', scheme: 'semi-implicit-euler',
    orders: { omega: 1, attitude: 1, position: 1, energy: 1, angular_momentum: 1, linear_momentum: 1 },
  }],
};
let body, gravity, state;

const cross = (a, b) => [0, 1, 2].map((i) => a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3]);
const times = (m, v) => [0, 1, 2].map((i) => m[3 * i] * v[0] + m[3 * i + 1] * v[1] + m[3 * i + 2] * v[2]);
const plus = (a, b, s) => a.map((x, i) => x + s * b[i]);

function solve(m, b) { // Cramer's rule, on columns of a symmetric matrix
  const [p, q, r] = [0, 3, 6].map((i) => m.slice(i, i + 3));
  const det = (a, c, d) => a[0] * cross(c, d)[0] + a[1] * cross(c, d)[1] + a[2] * cross(c, d)[2];
  return [det(b, q, r), det(p, b, r), det(p, q, b)].map((x) => x / det(p, q, r));
}
const angular = (w) => solve(body.inertia, cross(w, times(body.inertia, w)).map((x) => -x));

function turned(q, v) { // q times the quaternion of the rotation vector v, in body axes
  const angle = Math.hypot(...v), k = angle ? Math.sin(angle / 2) / angle : 0.5;
  const [a, b] = [q.slice(1), v.map((x) => k * x)], [s, c] = [q[0], Math.cos(angle / 2)];
  const imaginary = cross(a, b).map((x, i) => x + s * b[i] + c * a[i]);
  return [s * c - a[0] * b[0] - a[1] * b[1] - a[2] * b[2], ...imaginary];
}

function run({ initial, timestep: h, steps, every }) {
  let { orientation: q, angular_velocity: w, position: x, linear_velocity: v } = initial;
  const time = [], kept = { orientation: [], angular_velocity: [], position: [], linear_velocity: [] };
  for (let step = 0; step <= steps; step++) {
    if (step % every === 0 || step === steps) {
      time.push(step * h);
      Object.values(kept).forEach((rows, i) => rows.push([q, w, x, v][i]));
    }
    [w, v] = [plus(w, angular(w), h), plus(v, gravity, h)];
    [x, q] = [plus(x, v, h), turned(q, w.map((rate) => h * rate))];
  }
  return { time, state: kept };
}

const OPERATIONS = {
  describe: () => DESCRIPTION,
  load: ({ body: given, load }) => {
    const torque = [...load.torque_body, ...load.torque_world, load.damping].some((x) => x !== 0);
    if (load.pivot !== null || torque) throw { unsupported: 'toyjs knows free bodies without torque only' };
    [body, gravity] = [given, load.gravity];
    return null;
  },
  model: () => ({ ...body, inertia: [0, 3, 6].map((i) => body.inertia.slice(i, i + 3)) }),
  set_state: (request) => { state = request.state; return null; },
  get_state: () => state,
  forward: ({ states: { angular_velocity: w } }) => {
    const rows = Array.from({ length: w.length / 3 }, (_, i) => w.slice(3 * i, 3 * i + 3));
    return { angular: rows.map(angular), linear: rows.map(() => gravity) };
  },
  run,
};

function read(count) { // exactly so many bytes of standard input; at its end, leave
  const buffer = Buffer.alloc(count);
  for (let at = 0; at < count;) {
    const got = fs.readSync(0, buffer, at, count - at);
    if (!got) process.exit(0);
    at += got;
  }
  return buffer;
}

for (;;) {
  const header = JSON.parse(read(Number(read(8).readBigUInt64BE())));
  const arrays = header.shapes.map((shape) => {
    const bytes = read(8 * shape.reduce((a, b) => a * b, 1));
    const flat = Array.from({ length: bytes.length / 8 }, (_, i) => bytes.readDoubleLE(8 * i));
    return shape.length ? flat : flat[0];
  });
  const request = JSON.parse(JSON.stringify(header.body), (_, v) => (v && '$array' in Object(v) ? arrays[v.$array] : v));
  let answer;
  try {
    const operation = OPERATIONS[request.operation];
    answer = operation ? { outcome: 'ok', result: operation(request) } : { outcome: 'unsupported' };
  } catch (error) {
    answer = error.unsupported ? { outcome: 'unsupported', reason: error.unsupported }
      : { outcome: 'raised', reason: String(error) };
  }
  const text = Buffer.from(JSON.stringify({ body: answer, shapes: [] }));
  const length = Buffer.alloc(8);
  length.writeBigUInt64BE(BigInt(text.length));
  let rest = Buffer.concat([length, text]);
  while (rest.length) rest = rest.subarray(fs.writeSync(1, rest));
}
