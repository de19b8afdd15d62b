// /// finding
// engine = "rapier3d-compat"
// integrator = "step"
// setup = "as-shipped"
// scenario = "docs/findings/slow-sphere.toml"
// timestep = 0.01
// metric = "trajectory/position/error_max"
// reach = "extreme"
// kind = "default"
// title = "Slow bodies are put to sleep"
// what = "A body at 0.02 m/s in free space stops after half a second."
// why = "A body may sleep unless that is switched off."
// mends = "RigidBodyDesc.setCanSleep(false)"
// link = "https://rapier.rs/docs/user_guides/javascript/rigid_bodies"
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
  console.log('figure', behind(0.02, 0.02, 0.01, 500, 0.1, () => {}));
  console.log('mended', behind(0.02, 0.02, 0.01, 500, 0.1, (made) => made.setCanSleep(false)));
});
