// Bullet in single precision, compiled to JavaScript: one body, a sphere that touches nothing.
'use strict';
const { Unsupported } = require('./channel.js');
const { conjugate, principal, product, rotated, turnedDiagonal } = require('./rotations.js');
const { mends } = require('./setups.js');

const MOST_TURN = Math.PI / 4; // rad in a step; beyond, attitudes turn by less than omega does, whatever is set
const NEVER_ASLEEP = 4; // DISABLE_DEACTIVATION, which the binding does not name
const SWITCHED_OFF = ['sleep (setActivationState with DISABLE_DEACTIVATION, 4)'];
const SETTINGS = ['setActivationState'];

async function open(folder) {
  const api = require(folder);
  const settings = new api.btDefaultCollisionConfiguration();
  const parts = [
    new api.btCollisionDispatcher(settings), new api.btDbvtBroadphase(),
    new api.btSequentialImpulseConstraintSolver(), settings,
  ];
  // Vectors are objects of the program's own memory: these are filled again and again.
  const scratch = { vector: new api.btVector3(0, 0, 0), turn: new api.btQuaternion(0, 0, 0, 1), pose: new api.btTransform() };
  return { api, scratch, world: new api.btDiscreteDynamicsWorld(...parts) };
}

// Without torque a step is a scheme of the reference, whose steps take up a torque implicitly as well.
function description(opened, setup, driven) {
  return {
    name: 'ammo',
    licence: 'Zlib',
    precision: 'float32',
    features: ['free', 'gravity', 'torque', 'full_inertia', 'offset_com'],
    integrators: [{
      name: 'step',
      scheme: driven ? null : 'linearly-implicit-euler',
      order: 1,
      note: 'stepSimulation: w1 = w - (1 - h J)^-1 h I^-1 (w x I w) + h I^-1 t, J the derivative of -I^-1 (w x I w) by w, and the rotation of h w1',
    }],
    conventions: [
      'quaternions are (x, y, z, w), world-from-body; attitudes are kept as matrices',
      'transforms are those of the centre of mass along the principal axes; the frame of the body stands in the motion state, as an offset from there; all velocities are in world axes',
      'the inertia is three principal moments; neither it nor the mass can be read, so that both are taken from what an impulse does',
      'beyond a turn r of pi / 4 in a step an attitude turns by 2 atan(4 r / pi tan(pi / 8)): the adapter refuses to go on there',
      'the gyroscopic term is lost where the product of the moments is below 1.2e-7 kg^3 m^6',
      'a torque is in world axes and acts during one step: a torque in body axes is turned at the start of each step',
    ],
    switched_off: setup === 'physics' ? SWITCHED_OFF : [],
    settings: SETTINGS,
    links: ['https://github.com/kripken/ammo.js', 'https://github.com/bulletphysics/bullet3/blob/master/src/BulletDynamics/Dynamics/btRigidBody.cpp'],
  };
}

const refused = () => '';
const list = (found) => [found.x(), found.y(), found.z()];
const quaternion = (found) => [found.w(), ...list(found)];

class World {
  constructor(opened, setup, given, gravity) {
    Object.assign(this, opened);
    this.strict = setup === 'physics';
    this.world.setGravity(this.vector(gravity));
    this.made = this.bodyOf(given);
    [this.body] = this.made;
    const pose = this.body.getWorldTransform();
    [this.frame, this.center] = [quaternion(pose.getRotation()), list(pose.getOrigin())];
    this.held = this.readBack();
    if (mends(setup, 'setActivationState')) this.body.setActivationState(NEVER_ASLEEP);
    this.world.addRigidBody(this.body);
  }

  // The body, with what it is made of. Its own frame is at the world's origin.
  bodyOf({ mass, center_of_mass: center, inertia }) {
    const { api } = this;
    const { moments, frame } = principal(inertia);
    const start = new api.btTransform();
    start.setIdentity();
    const back = conjugate(frame);
    const motion = new api.btDefaultMotionState(start, this.pose(back, rotated(back, center).map((x) => -x)));
    const shape = new api.btSphereShape(1);
    const settings = new api.btRigidBodyConstructionInfo(mass, motion, shape, this.vector(moments));
    const body = new api.btRigidBody(settings);
    for (const used of [start, settings]) api.destroy(used);
    return [body, shape, motion];
  }

  // Mass and inertia, from the velocities that unit impulses give along the principal axes.
  readBack() {
    this.body.setCenterOfMassTransform(this.pose([1, 0, 0, 0], [0, 0, 0]));
    this.body.applyCentralImpulse(this.vector([1, 0, 0]));
    this.body.applyTorqueImpulse(this.vector([1, 1, 1]));
    const moments = list(this.body.getAngularVelocity()).map((x) => 1 / x);
    return { mass: 1 / this.body.getLinearVelocity().x(), inertia: turnedDiagonal(this.frame, moments) };
  }

  vector(values) {
    this.scratch.vector.setValue(...values);
    return this.scratch.vector;
  }

  pose([w, x, y, z], place) {
    const { pose, turn } = this.scratch;
    turn.setValue(x, y, z, w);
    pose.setRotation(turn);
    pose.setOrigin(this.vector(place));
    return pose;
  }

  put({ q, w, p, v }) {
    this.body.setCenterOfMassTransform(this.pose(product(q, this.frame), p));
    this.body.setLinearVelocity(this.vector(v));
    this.body.setAngularVelocity(this.vector(w));
  }

  state() {
    const pose = this.body.getWorldTransform();
    const q = product(quaternion(pose.getRotation()), conjugate(this.frame));
    return { q, w: list(this.body.getAngularVelocity()), p: list(pose.getOrigin()), v: list(this.body.getLinearVelocity()) };
  }

  step(h, torque) {
    if (torque) this.body.applyTorque(this.vector(torque));
    this.world.stepSimulation(h, 1, h);
    if (this.strict) this.refuseLong(h);
  }

  refuseLong(h) {
    if (Math.hypot(...list(this.body.getAngularVelocity())) * h < MOST_TURN * (1 - 1e-5)) return;
    throw new Unsupported('Bullet turns a body by less than omega does beyond 45 degrees in a step; take smaller steps');
  }

  model() {
    return { ...this.held, center_of_mass: this.center };
  }

  free() {
    this.world.removeRigidBody(this.body);
    for (const used of this.made) this.api.destroy(used);
  }
}

module.exports = { open, description, refused, World };
