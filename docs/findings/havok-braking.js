// /// finding
// engine = "havok"
// integrator = "step"
// setup = "physics"
// scenario = "docs/findings/slow-sphere.toml"
// timestep = 0.01
// metric = "trajectory/position/error_max"
// reach = "extreme"
// kind = "wrong field"
// title = "Slow bodies are braked"
// what = "A body at 0.02 m/s in free space stops."
// why = "Below 0.1 m/s the centre of mass loses 0.31 m/s each second, with all damping off, no contact and no sleep; nothing switches that off."
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
  const [world, body] = make(api, [0.4, 0.4, 0.4], [0.02, 0, 0], [0, 0, 0.02], mend);
  for (let n = 0; n < 500; n += 1) api.HP_World_Step(world, 0.01);
  console.log('release', JSON.parse(fs.readFileSync(path.join(folder, 'package.json'))).version);
  console.log('figure', Math.abs(api.HP_Body_GetQTransform(body)[1][0][0] - 0.1));
});
