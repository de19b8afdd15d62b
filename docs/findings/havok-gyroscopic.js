// /// finding
// engine = "havok"
// integrator = "step"
// setup = "physics"
// scenario = "docs/findings/brick.toml"
// timestep = 0.01
// metric = "invariants/angular_momentum/drift_full"
// kind = "missing term"
// reach = "ordinary"
// title = "There is no gyroscopic term"
// what = "A brick that nothing touches keeps its omega in world axes, so that its angular momentum turns with it; a T-handle never flips."
// why = "HP_World_Step has no term omega x I omega, and the interface no switch for one. A sphere is right."
// link = "https://github.com/BabylonJS/havok/blob/main/packages/havok/HavokPhysics.d.ts"
// ///
'use strict';
const fs = require('fs');
const path = require('path');

const file = require.resolve('@babylonjs/havok');
const folder = file.slice(0, file.indexOf('havok', file.indexOf('@babylonjs')) + 'havok'.length);
const wasmBinary = fs.readFileSync(path.join(folder, 'lib', 'umd', 'HavokPhysics.wasm'));
const start = require(path.join(folder, 'lib', 'umd', 'HavokPhysics_umd.js'));

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

function make(api, moments, v, omega, mend) {
  const [world, body] = [api.HP_World_Create()[1], api.HP_Body_Create()[1]];
  api.HP_World_SetGravity(world, [0, 0, 0]);
  api.HP_Body_SetMotionType(body, api.MotionType.DYNAMIC);
  api.HP_Body_SetMassProperties(body, [[0, 0, 0], 1, moments, [0, 0, 0, 1]]);
  mend(world, body);
  api.HP_World_AddBody(world, body, false);
  api.HP_Body_SetLinearVelocity(body, v);
  api.HP_Body_SetAngularVelocity(body, omega);
  return [world, body];
}

start({ wasmBinary }).then((api) => {
  const mend = (_, body) => {
    api.HP_Body_SetLinearDamping(body, 0);
    api.HP_Body_SetAngularDamping(body, 0);
    api.HP_Body_SetActivationControl(body, api.ActivationControl.ALWAYS_ACTIVE);
  };
  const [world, body] = make(api, MOMENTS, [0, 0, 0], [1, 2, 3], mend);
  const state = () => [api.HP_Body_GetQTransform(body)[1][1], api.HP_Body_GetAngularVelocity(body)[1]];
  console.log('release', JSON.parse(fs.readFileSync(path.join(folder, 'package.json'))).version);
  console.log('figure', drift((h) => api.HP_World_Step(world, h), state));
});
