// Rotations and symmetric matrices. Quaternions are (w, x, y, z), world-from-body; matrices are
// flat lists of nine, row after row.
'use strict';

const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

// v turned by q. A q that is not quite unit turns as its direction does: v + 2 (w u + u x u) / |q|^2
// with u = (x, y, z) x v.
function rotated(q, v) {
  const [w, ...axis] = q;
  const u = cross(axis, v);
  const again = cross(axis, u);
  const scale = 2 / (w * w + axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]);
  return v.map((x, i) => x + scale * (w * u[i] + again[i]));
}

// The rotation of b, then that of a.
function product([a, ...u], [b, ...v]) {
  const turned = cross(u, v);
  return [a * b - u[0] * v[0] - u[1] * v[1] - u[2] * v[2], ...turned.map((x, i) => x + a * v[i] + b * u[i])];
}

const conjugate = ([w, x, y, z]) => [w, -x, -y, -z];

// The matrix R diag(moments) R^T, with R the rotation of q.
function turnedDiagonal(q, moments) {
  const axes = [[1, 0, 0], [0, 1, 0], [0, 0, 1]].map((axis) => rotated(q, axis));
  const entry = (i, j) => moments.reduce((sum, moment, k) => sum + moment * axes[k][i] * axes[k][j], 0);
  return [0, 1, 2].flatMap((i) => [0, 1, 2].map((j) => entry(i, j)));
}

// Principal moments of a symmetric matrix and the quaternion of their axes, by Jacobi's rotations.
function principal(matrix) {
  const a = [0, 3, 6].map((i) => matrix.slice(i, i + 3));
  const axes = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]; // columns of R, as rows
  for (let sweep = 0; sweep < 32; sweep++) {
    for (const [p, q] of [[0, 1], [0, 2], [1, 2]]) {
      if (a[p][q] === 0) continue;
      const theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
      const t = Math.sign(theta || 1) / (Math.abs(theta) + Math.hypot(theta, 1));
      const c = 1 / Math.hypot(t, 1);
      const s = t * c;
      turnPair(axes, p, q, c, s);
      turnPair(a, p, q, c, s); // rows, then columns
      for (const row of a) [row[p], row[q]] = [c * row[p] - s * row[q], s * row[p] + c * row[q]];
      if (Math.abs(a[p][q]) < Number.MIN_VALUE) [a[p][q], a[q][p]] = [0, 0];
    }
  }
  return { moments: [0, 1, 2].map((i) => a[i][i]), frame: quaternionOf(axes) };
}

function turnPair(rows, p, q, c, s) {
  [rows[p], rows[q]] = [
    rows[p].map((x, i) => c * x - s * rows[q][i]), rows[q].map((x, i) => s * rows[p][i] + c * x),
  ];
}

// The quaternion of the rotation with these columns, by the largest of its four components.
function quaternionOf([x, y, z]) {
  const squares = [
    1 + x[0] + y[1] + z[2], 1 + x[0] - y[1] - z[2], 1 - x[0] + y[1] - z[2], 1 - x[0] - y[1] + z[2],
  ];
  const large = squares.indexOf(Math.max(...squares));
  const unscaled = [
    [squares[0], y[2] - z[1], z[0] - x[2], x[1] - y[0]],
    [y[2] - z[1], squares[1], y[0] + x[1], z[0] + x[2]],
    [z[0] - x[2], y[0] + x[1], squares[2], z[1] + y[2]],
    [x[1] - y[0], z[0] + x[2], z[1] + y[2], squares[3]],
  ][large];
  const length = Math.hypot(...unscaled);
  return unscaled.map((value) => value / length);
}

module.exports = { conjugate, principal, product, rotated, turnedDiagonal };
