// /// finding
// engine = "cannon-es"
// integrator = "step"
// setup = "physics"
// scenario = "docs/findings/brick.toml"
// timestep = 0.01
// metric = "invariants/angular_momentum/drift_full"
// kind = "missing term"
// reach = "ordinary"
// title = "There is no gyroscopic term"
// what = "A brick that nothing touches keeps its omega in world axes, so that its angular momentum turns with it; a T-handle never flips."
// why = "World.step has no term omega x I omega, and no switch for one. A sphere is right."
// link = "https://github.com/pmndrs/cannon-es/blob/master/src/objects/Body.ts"
// ///
'use strict';
const { Body, Vec3, World } = require('cannon-es');
const fs = require('fs');
const path = require('path');

const MOMENTS = [1, 2, 2.5];
// The matrix of a quaternion (x, y, z, w), by rows.
const matrix = (x, y, z, w) => [
  [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
  [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
  [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
];
// R I R^T omega, in world axes.
function momentum(turn, omega) {
  const r = matrix(...turn);
  const own = MOMENTS.map((moment, j) => moment * (r[0][j] * omega[0] + r[1][j] * omega[1] + r[2][j] * omega[2]));
  return r.map((row) => row[0] * own[0] + row[1] * own[1] + row[2] * own[2]);
}
// How far the angular momentum drifts in 2 s, in parts of itself.
function drift(step, state) {
  const first = momentum(...state());
  let worst = 0;
  for (let n = 1; n <= 200; n += 1) {
    step(0.01);
    if (n % 2) continue;
    const gap = momentum(...state()).map((x, i) => x - first[i]);
    worst = Math.max(worst, Math.hypot(...gap) / Math.hypot(...first));
  }
  return worst;
}

const world = new World();
const body = new Body({ mass: 1, linearDamping: 0, angularDamping: 0 });
body.inertia.set(...MOMENTS);
body.invInertia.set(...MOMENTS.map((moment) => 1 / moment));
body.angularVelocity.set(1, 2, 3);
world.addBody(body);
const state = () => [body.quaternion.toArray(), body.angularVelocity.toArray()];
const about = path.join(path.dirname(require.resolve('cannon-es')), '..', 'package.json');
console.log('release', JSON.parse(fs.readFileSync(about)).version);
console.log('figure', drift((h) => world.step(h), state));
