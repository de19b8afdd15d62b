// /// finding
// engine = "ammo"
// integrator = "step"
// setup = "physics"
// scenario = "docs/findings/small-brick.toml"
// timestep = 0.01
// metric = "invariants/angular_momentum/drift_full"
// kind = "missing term"
// reach = "ordinary"
// title = "Bodies with small moments have no gyroscopic term"
// what = "The angular momentum of a free brick of 50 g turns with it; the T-handle of 0.37 kg never flips."
// why = "The term is solved for by a 3x3 solver that divides by its determinant only above 1.2e-7, whatever the unit is. It is lost where the product of the moments is below 1.2e-7 kg^3 m^6."
// link = "https://github.com/bulletphysics/bullet3/blob/master/src/LinearMath/btMatrix3x3.h"
// ///
'use strict';
const fs = require('fs');
const path = require('path');

const api = require('ammo.js');
const about = path.join(path.dirname(require.resolve('ammo.js')), 'package.json');
const release = JSON.parse(fs.readFileSync(about)).version;

const MOMENTS = [1e-5, 2e-5, 2.5e-5];
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

function make(mass, moments, v, omega) {
  const settings = new api.btDefaultCollisionConfiguration();
  const parts = [new api.btCollisionDispatcher(settings), new api.btDbvtBroadphase(), new api.btSequentialImpulseConstraintSolver()];
  const world = new api.btDiscreteDynamicsWorld(...parts, settings);
  const vector = (values) => new api.btVector3(...values);
  world.setGravity(vector([0, 0, 0]));
  const pose = new api.btTransform();
  pose.setIdentity();
  const given = [mass, new api.btDefaultMotionState(pose), new api.btSphereShape(1), vector(moments)];
  const body = new api.btRigidBody(new api.btRigidBodyConstructionInfo(...given));
  world.addRigidBody(body);
  body.setLinearVelocity(vector(v));
  body.setAngularVelocity(vector(omega));
  return [world, body];
}
const list = (vector) => [vector.x(), vector.y(), vector.z()];

const [world, body] = make(0.05, MOMENTS, [0, 0, 0], [1, 2, 3]);
body.setActivationState(4);
const turn = () => body.getWorldTransform().getRotation();
const state = () => [[...list(turn()), turn().w()], list(body.getAngularVelocity())];
console.log('release', release);
console.log('figure', drift((h) => world.stepSimulation(h, 1, h), state));
