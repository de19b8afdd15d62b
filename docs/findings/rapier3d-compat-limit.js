// /// finding
// engine = "rapier3d-compat"
// integrator = "step"
// scenario = "docs/findings/fast-sphere.toml"
// setup = "as-shipped"
// timestep = 0.002
// kind = "default"
// reach = "extreme"
// metric = "trajectory/position/error_max"
// title = "Speeds are cut to 400 m/s"
// what = "Of 600 m/s a body keeps 400 m/s."
// why = "The limit is 400 times lengthUnit, which scales tolerances of contacts as well."
// mends = "world.integrationParameters.lengthUnit = 1e12"
// link = "https://github.com/dimforge/rapier"
// ///
'use strict';
const api = require('@dimforge/rapier3d-compat');
const fs = require('fs');
const path = require('path');

const about = path.join(path.dirname(require.resolve('@dimforge/rapier3d-compat')), '..', 'package.json');

function behind(v, omega, h, steps, exact, mend) {
  const world = new api.World({ x: 0, y: 0, z: 0 });
  const made = api.RigidBodyDesc.dynamic();
  made.setAdditionalMassProperties(1, { x: 0, y: 0, z: 0 }, { x: 0.4, y: 0.4, z: 0.4 }, { x: 0, y: 0, z: 0, w: 1 });
  mend(made, world);
  const body = world.createRigidBody(made);
  body.setLinvel({ x: v, y: 0, z: 0 }, true);
  body.setAngvel({ x: 0, y: 0, z: omega }, true);
  world.timestep = h;
  for (let n = 0; n < steps; n += 1) world.step();
  return Math.abs(body.translation().x - exact);
}

api.init().then(() => {
  console.log('release', JSON.parse(fs.readFileSync(about)).version);
  const mend = (_, world) => {
    world.integrationParameters.lengthUnit = 1e12;
  };
  console.log('figure', behind(600, 150, 0.002, 20, 24, () => {}));
  console.log('mended', behind(600, 150, 0.002, 20, 24, mend));
});
