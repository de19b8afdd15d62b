// /// finding
// engine = "havok"
// integrator = "step"
// scenario = "docs/findings/fast-sphere.toml"
// setup = "as-shipped"
// timestep = 0.002
// kind = "default"
// reach = "extreme"
// metric = "trajectory/position/error_max"
// title = "Speeds are cut to 200 m/s and 100 rad/s"
// what = "Of 600 m/s a body keeps 200 m/s."
// why = "A world is made with these limits."
// mends = "HP_World_SetSpeedLimit(world, 1e18, 1e18)"
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
  const behind = (mend) => {
    const [world, body] = make(api, [0.4, 0.4, 0.4], [600, 0, 0], [0, 0, 150], mend);
    for (let n = 0; n < 20; n += 1) api.HP_World_Step(world, 0.002);
    return Math.abs(api.HP_Body_GetQTransform(body)[1][0][0] - 24);
  };
  console.log('release', JSON.parse(fs.readFileSync(path.join(folder, 'package.json'))).version);
  console.log('figure', behind(() => {}));
  console.log('mended', behind((world) => api.HP_World_SetSpeedLimit(world, 1e18, 1e18)));
});
