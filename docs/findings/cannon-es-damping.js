// /// finding
// engine = "cannon-es"
// integrator = "step"
// scenario = "sphere"
// setup = "as-shipped"
// timestep = 0.01
// metric = "trajectory/omega/error_max"
// kind = "default"
// reach = "ordinary"
// title = "Every body is damped"
// what = "A sphere that nothing touches loses 5 % of its omega in 5 s."
// why = "linearDamping and angularDamping are 0.01: velocities are multiplied by 0.99^h at each step."
// mends = "new Body({ linearDamping: 0, angularDamping: 0 })"
// link = "https://github.com/pmndrs/cannon-es/blob/master/src/objects/Body.ts"
// ///
'use strict';
const { Body, Vec3, World } = require('cannon-es');
const fs = require('fs');
const path = require('path');

// How much of omega is lost in 5 s.
function lost(step, omega) {
  for (let n = 0; n < 500; n += 1) step(0.01);
  return Math.hypot(omega()[0] - 1, omega()[1] - 2, omega()[2] - 3) / Math.hypot(1, 2, 3);
}

function sphere(mended) {
  const world = new World();
  const body = new Body({ mass: 1, ...mended });
  for (const held of [body.inertia, body.invInertia]) held.set(1, 1, 1);
  body.angularVelocity = new Vec3(1, 2, 3);
  world.addBody(body);
  return lost((h) => world.step(h), () => body.angularVelocity.toArray());
}
const about = path.join(path.dirname(require.resolve('cannon-es')), '..', 'package.json');
console.log('release', JSON.parse(fs.readFileSync(about)).version);
console.log('figure', sphere({}));
console.log('mended', sphere({ linearDamping: 0, angularDamping: 0 }));
