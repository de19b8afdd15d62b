// Quaternions are [w, x, y, z], world from body; vectors are [x, y, z].
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const times = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
const plus = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = (a) => times(a, 1 / (Math.hypot(...a) || 1));
const across = (matrix, a) => [0, 3, 6].map((row) => matrix[row] * a[0] + matrix[row + 1] * a[1] + matrix[row + 2] * a[2]);

const inverse = ([w, x, y, z]) => [w, -x, -y, -z];
const product = ([a, b, c, d], [e, f, g, h]) => [
  a * e - b * f - c * g - d * h, a * f + b * e + c * h - d * g,
  a * g - b * h + c * e + d * f, a * h + b * g - c * f + d * e,
];
function rotate([w, x, y, z], [a, b, c]) {
  const p = 2 * (y * c - z * b), q = 2 * (z * a - x * c), r = 2 * (x * b - y * a);
  return [a + w * p + y * r - z * q, b + w * q + z * p - x * r, c + w * r + x * q - y * p];
}
function turnBy(vector) {
  const angle = Math.hypot(...vector), share = angle > 0 ? Math.sin(angle / 2) / angle : 0.5;
  return [Math.cos(angle / 2), ...times(vector, share)];
}
function angleBetween(a, b) {
  const [w, ...v] = product(inverse(a), b);
  return 2 * Math.atan2(Math.hypot(...v), Math.abs(w));
}
// The short way from a to b at an even rate.
function slerp(a, b, share) {
  const [w, ...v] = product(inverse(a), b), sine = Math.hypot(...v), sign = w < 0 ? -1 : 1;
  if (sine < 1e-9) return b;
  const angle = 2 * Math.atan2(sine, sign * w);
  return product(a, turnBy(times(v, (share * sign * angle) / sine)));
}

// Tables of signed 16-bit codes, column after column.
const LARGEST_CODE = 32767;
function columns(codes, start, count, width, largest) {
  const row = (i) => Array.from({ length: width }, (_, k) => (codes[start + k * count + i] / LARGEST_CODE) * largest);
  return Array.from({ length: count }, (_, i) => row(i));
}

// Trajectories of attitude and omega: `time`, `q` and `w` by sample.
function exactTrajectory({ codes, data }, scenario) {
  const count = scenario.times.length, q = columns(codes, scenario.start, count, 4, 1);
  const w = columns(codes, scenario.start + 4 * count, count, 3, scenario.fastest);
  return { name: `exact, ${scenario.truth}`, knob: "", line: -1, time: scenario.times, q: q.map(normal), w, end: scenario.times.at(-1), diverges: null, largest: 0, flips: scenario.flips };
}
const normal = (q) => q.map((part) => part / Math.hypot(...q));
function runTrajectory({ codes, data }, scenario, exact, entry) {
  const [line, rank, knob, clock, start, count, diverges, largest, end, gates, flips, turns] = entry;
  const frames = scenario.frames[clock];
  const error = columns(codes, start, count, 3, Math.PI);
  const spin = columns(codes, start + 3 * count, count, 3, data.spins * scenario.fastest);
  return {
    name: data.lines[line].name, knob, line, rank, diverges, largest, end, gates, flips, turns,
    time: frames.map((f) => scenario.times[f]),
    q: frames.map((f, i) => product(exact.q[f], turnBy(error[i]))),
    w: frames.map((f, i) => plus(exact.w[f], spin[i])),
    error: error.map((e) => (Math.hypot(...e) * 180) / Math.PI),
  };
}
// A trajectory at a time; after its last sample it stands still.
function poseAt(trajectory, time) {
  const { time: t, q, w } = trajectory;
  if (time >= t.at(-1)) return { q: q.at(-1), w: w.at(-1), ended: time > t.at(-1) };
  let low = 0, high = t.length - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (t[middle] <= time) low = middle;
    else high = middle;
  }
  const share = Math.max(0, (time - t[low]) / (t[high] - t[low]));
  return { q: slerp(q[low], q[high], share), w: plus(times(w[low], 1 - share), times(w[high], share)), ended: false };
}
