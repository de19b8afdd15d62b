// Rapier in single precision, compiled to WebAssembly: a world of one body without a collider.
'use strict';
const { Unsupported } = require('./channel.js');
const { principal, rotated, turnedDiagonal } = require('./rotations.js');
const { mends } = require('./setups.js');

// The limit of linear velocity is 400 m/s in this unit. It scales tolerances of contacts besides.
const UNIT = 1e12;
const MOST_TURN = Math.PI / 4; // rad in a step; omega is cut down to it, and no option changes that
const SWITCHED_OFF = [
  'sleep (RigidBodyDesc.setCanSleep)',
  'the limit of 400 m/s (IntegrationParameters.lengthUnit raises it)',
];
const SETTINGS = ['setCanSleep', 'lengthUnit'];

async function open(folder) {
  const api = require(folder);
  await api.init();
  return api;
}

function description(api, setup) {
  return {
    name: 'rapier3d-compat',
    licence: 'Apache-2.0',
    precision: 'float32',
    features: ['free', 'gravity', 'torque', 'full_inertia', 'offset_com'],
    integrators: [{
      name: 'step',
      scheme: 'semi-implicit-euler-rescaled-momentum-four-substeps',
      order: 1,
      note: 'World.step, in numSolverIterations = 4 substeps: w = w0 + h a, L = I w, w1 = I^-1 (L - h w x L) |L| / |L - h w x L|, q1 = q + h/2 (0, w1) q, made unit; a = I^-1 t stays in world axes',
    }],
    conventions: [
      'quaternions are (x, y, z, w), world-from-body',
      "a body's translation is that of its origin, its linvel that of its centre of mass; all velocities are in world axes",
      'the inertia is three principal moments about the centre of mass, and the quaternion of their axes',
      'omega is cut down to what turns a body by pi / 4 in a step: the adapter refuses to go on there',
      'a torque is in world axes and acts until it is reset: a torque in body axes is turned at the start of each step',
    ],
    switched_off: setup === 'physics' ? SWITCHED_OFF : [],
    settings: SETTINGS,
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
    this.strict = setup === 'physics';
    if (mends(setup, 'setCanSleep')) made.setCanSleep(false);
    if (mends(setup, 'lengthUnit')) this.world.integrationParameters.lengthUnit = UNIT;
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
    if (this.strict) this.refuseCut(h);
  }

  refuseCut(h) {
    const { x, y, z } = this.body.angvel();
    if (Math.hypot(x, y, z) * h < MOST_TURN * (1 - 1e-5)) return;
    throw new Unsupported('Rapier turns a body by at most 45 degrees in a step, and cuts omega down to that; take smaller steps');
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
