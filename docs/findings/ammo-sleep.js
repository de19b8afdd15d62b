// /// finding
// engine = "ammo"
// integrator = "step"
// setup = "as-shipped"
// scenario = "docs/findings/slow-sphere.toml"
// timestep = 0.01
// metric = "trajectory/position/error_max"
// reach = "extreme"
// kind = "default"
// title = "Slow bodies are put to sleep"
// what = "A body at 0.02 m/s in free space stops after 2 s."
// why = "A body may be deactivated unless its activation state is DISABLE_DEACTIVATION, 4."
// mends = "setActivationState(4)"
// link = "https://github.com/bulletphysics/bullet3/blob/master/src/BulletDynamics/Dynamics/btRigidBody.cpp"
// ///
'use strict';
const fs = require('fs');
const path = require('path');

const api = require('ammo.js');
const about = path.join(path.dirname(require.resolve('ammo.js')), 'package.json');
const release = JSON.parse(fs.readFileSync(about)).version;

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

const behind = (mended) => {
  const [world, body] = make(1, [0.4, 0.4, 0.4], [0.02, 0, 0], [0, 0, 0.02]);
  if (mended) body.setActivationState(4);
  for (let n = 0; n < 500; n += 1) world.stepSimulation(0.01, 1, 0.01);
  return Math.abs(body.getWorldTransform().getOrigin().x() - 0.1);
};
console.log('release', release);
console.log('figure', behind(false));
console.log('mended', behind(true));
