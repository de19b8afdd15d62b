// /// finding
// engine = "havok"
// integrator = "step"
// scenario = "sphere"
// setup = "as-shipped"
// timestep = 0.01
// metric = "trajectory/omega/error_max"
// kind = "default"
// reach = "ordinary"
// title = "Omega is damped"
// what = "A sphere that nothing touches loses two fifths of its omega in 5 s."
// why = "The angular damping is 0.1: omega is multiplied by 1 - 0.1 h at each step."
// mends = "HP_Body_SetAngularDamping(body, 0)"
// link = "https://github.com/BabylonJS/havok/blob/main/packages/havok/HavokPhysics.d.ts"
// ///
'use strict';
const fs = require('fs');
const path = require('path');

const file = require.resolve('@babylonjs/havok');
const folder = file.slice(0, file.indexOf('havok', file.indexOf('@babylonjs')) + 'havok'.length);
const wasmBinary = fs.readFileSync(path.join(folder, 'lib', 'umd', 'HavokPhysics.wasm'));
const start = require(path.join(folder, 'lib', 'umd', 'HavokPhysics_umd.js'));

// How much of omega is lost in 5 s.
function lost(step, omega) {
  for (let n = 0; n < 500; n += 1) step(0.01);
  return Math.hypot(omega()[0] - 1, omega()[1] - 2, omega()[2] - 3) / Math.hypot(1, 2, 3);
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
  const sphere = (mend) => {
    const [world, body] = make(api, [1, 1, 1], [0.5, -0.25, 0.125], [1, 2, 3], mend);
    return lost((h) => api.HP_World_Step(world, h), () => api.HP_Body_GetAngularVelocity(body)[1]);
  };
  console.log('release', JSON.parse(fs.readFileSync(path.join(folder, 'package.json'))).version);
  console.log('figure', sphere(() => {}));
  console.log('mended', sphere((_, body) => api.HP_Body_SetAngularDamping(body, 0)));
});
