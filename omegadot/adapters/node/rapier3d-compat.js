// Rapier in single precision, compiled to WebAssembly: a world of one body without a collider.
'use strict';
const { principal, rotated, turnedDiagonal } = require('./rotations.js');

async function open(folder) {
  const api = require(folder);
  await api.init();
  return api;
}

function description(api, setup) {
  const channels = ['omega', 'attitude', 'energy', 'angular_momentum', 'linear_momentum', 'position'];
  return {
    name: 'rapier3d-compat',
    licence: 'Apache-2.0',
    precision: 'float32',
    features: ['free', 'gravity', 'torque', 'full_inertia', 'offset_com'],
    integrators: [{
      name: 'step',
      scheme: null,
      orders: Object.fromEntries(channels.map((channel) => [channel, 1])),
      note: 'World.step, of numSolverIterations = 4 substeps',
    }],
    conventions: [
      'quaternions are (x, y, z, w), world-from-body',
      "a body's translation is that of its origin, its linvel that of its centre of mass; all velocities are in world axes",
      'the inertia is three principal moments about the centre of mass, and the quaternion of their axes',
      'a torque is in world axes and acts until it is reset: a torque in body axes is turned at the start of each step',
    ],
    switched_off: setup === 'physics' ? ['sleep (RigidBodyDesc.setCanSleep)'] : [],
    links: ['https://github.com/dimforge/rapier', 'https://rapier.rs/docs/user_guides/javascript/rigid_bodies'],
  };
}

const refused = () => '';
const vector = ([x, y, z]) => ({ x, y, z });
const list = ({ x, y, z }) => [x, y, z];
const quaternion = ([w, x, y, z]) => ({ x, y, z, w });

class World {
  constructor({ World: RapierWorld, RigidBodyDesc }, setup, body, gravity) {
    this.world = new RapierWorld(vector(gravity));
    const { moments, frame } = principal(body.inertia);
    const given = [body.mass, vector(body.center_of_mass), vector(moments), quaternion(frame)];
    const made = RigidBodyDesc.dynamic().setAdditionalMassProperties(...given);
    if (setup === 'physics') made.setCanSleep(false);
    this.body = this.world.createRigidBody(made);
    this.body.recomputeMassPropertiesFromColliders(); // they are zero before the first step
    this.center = list(this.body.localCom());
  }

  put({ q, w, p, v }) {
    const lever = rotated(q, this.center);
    this.body.setRotation(quaternion(q), true);
    this.body.setTranslation(vector(p.map((x, i) => x - lever[i])), true);
    this.body.setLinvel(vector(v), true);
    this.body.setAngvel(vector(w), true);
  }

  state() {
    const { x, y, z, w } = this.body.rotation();
    const lever = rotated([w, x, y, z], this.center);
    const place = list(this.body.translation());
    const p = place.map((value, i) => value + lever[i]);
    return { q: [w, x, y, z], w: list(this.body.angvel()), p, v: list(this.body.linvel()) };
  }

  step(h, torque) {
    if (torque) {
      this.body.resetTorques(true);
      this.body.addTorque(vector(torque), true);
    }
    this.world.timestep = h;
    this.world.step();
  }

  model() {
    const { x, y, z, w } = this.body.principalInertiaLocalFrame();
    const inertia = turnedDiagonal([w, x, y, z], list(this.body.principalInertia()));
    return { mass: this.body.mass(), center_of_mass: this.center, inertia };
  }

  free() {
    this.world.free();
  }
}

module.exports = { open, description, refused, World };
