// /// finding
// engine = "havok"
// integrator = "step"
// setup = "physics"
// scenario = "docs/findings/pushed-sphere.toml"
// timestep = 0.01
// metric = "trajectory/omega/error_max"
// kind = "precision limit"
// reach = "ordinary"
// title = "A torque meets moments of inertia of 8 bits"
// what = "A sphere under a constant torque gets omega-dot wrong by tenths of a per cent."
// why = "The inverses of the moments, which an impulse meets, are kept to 8 bits, whatever is read back."
// link = "https://github.com/BabylonJS/havok/blob/main/packages/havok/HavokPhysics.d.ts"
// ///
'use strict';
const fs = require('fs');
const path = require('path');

const file = require.resolve('@babylonjs/havok');
const folder = file.slice(0, file.indexOf('havok', file.indexOf('@babylonjs')) + 'havok'.length);
const wasmBinary = fs.readFileSync(path.join(folder, 'lib', 'umd', 'HavokPhysics.wasm'));
const start = require(path.join(folder, 'lib', 'umd', 'HavokPhysics_umd.js'));

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
  const [world, body] = make(api, [0.4981, 0.4981, 0.4981], [1, 0, 0], [0, 0, 1], mend);
  for (let n = 0; n < 20; n += 1) {
    api.HP_Body_ApplyAngularImpulse(body, [0, 0, 0.01 * 50]);
    api.HP_World_Step(world, 0.01);
  }
  const exact = 1 + (0.2 * 50) / 0.4981;
  console.log('release', JSON.parse(fs.readFileSync(path.join(folder, 'package.json'))).version);
  console.log('figure', Math.abs(api.HP_Body_GetAngularVelocity(body)[1][2] / exact - 1));
});
