// Havok in single precision, compiled to WebAssembly: a world of one body without a shape. There is no
// gyroscopic term.
'use strict';
const fs = require('fs');
const path = require('path');
const { principal, rotated, turnedDiagonal } = require('./rotations.js');
const { mends } = require('./setups.js');

const FAST = 1e18; // its square is finite in single precision
const SWITCHED_OFF = [
  'angular damping of 0.1: omega is multiplied by 1 - d h at each step',
  'the limits of 200 m/s and 100 rad/s (HP_World_SetSpeedLimit)',
  'sleep (HP_Body_SetActivationControl)',
  'solver parameters that follow from the length of a step (HP_World_SetIdealStepTime)',
];
const SETTINGS = [
  'HP_Body_SetLinearDamping', 'HP_Body_SetAngularDamping', 'HP_Body_SetActivationControl', 'HP_World_SetSpeedLimit',
  'HP_World_SetIdealStepTime',
];

async function open(folder) {
  const files = path.join(folder, 'lib', 'umd');
  const start = require(path.join(files, 'HavokPhysics_umd.js'));
  return start({ wasmBinary: fs.readFileSync(path.join(files, 'HavokPhysics.wasm')) });
}

function description(api, setup) {
  return {
    name: 'havok',
    licence: 'MIT',
    precision: 'float32',
    features: ['free', 'gravity', 'torque', 'full_inertia', 'offset_com'],
    integrators: [{
      name: 'step',
      order: 1,
      note: 'HP_World_Step: w1 = w + h R I^-1 R^T t in world axes, without omega x I omega, and the rotation of h w1; v1 = v + h g / 4 in each of four substeps',
    }],
    conventions: [
      'quaternions are (x, y, z, w), world-from-body',
      "a body's position is that of its origin, its linear velocity that of its centre of mass; all velocities are in world axes",
      'the inertia is three principal moments about the centre of mass, for a mass of 1 kg, and the quaternion of their axes',
      'a body slower than 0.1 m/s is braked by 0.31 m/s^2, and nothing switches that off',
      'the inverses of the moments, which an impulse meets, are kept to 8 bits, whatever is read back',
      'no gyroscopic term: a step without torque keeps omega in world axes, where the motion keeps the angular momentum',
      'there are impulses only: a torque is an angular impulse h t in world axes at the start of each step',
    ],
    switched_off: setup === 'physics' ? SWITCHED_OFF : [],
    settings: SETTINGS,
    links: ['https://github.com/BabylonJS/havok', 'https://github.com/BabylonJS/havok/blob/main/packages/havok/HavokPhysics.d.ts'],
  };
}

const refused = () => '';

// What a call gives beside its outcome, which is 0 where it did what it should.
function checked(found) {
  const [{ value: outcome }, value] = Array.isArray(found) ? found : [found];
  if (outcome !== 0) throw new Error(`a call of Havok's failed, with the result ${outcome}`);
  return value;
}

class World {
  constructor(api, setup, given, gravity) {
    this.api = api;
    this.world = checked(api.HP_World_Create());
    this.body = checked(api.HP_Body_Create());
    const { moments, frame: [w, x, y, z] } = principal(given.inertia);
    checked(api.HP_World_SetGravity(this.world, gravity));
    checked(api.HP_Body_SetMotionType(this.body, api.MotionType.DYNAMIC));
    const perMass = moments.map((moment) => moment / given.mass);
    checked(api.HP_Body_SetMassProperties(this.body, [given.center_of_mass, given.mass, perMass, [x, y, z, w]]));
    this.mend(setup);
    checked(api.HP_World_AddBody(this.world, this.body, false));
    [this.center] = checked(api.HP_Body_GetMassProperties(this.body));
  }

  mend(setup) {
    const { api, world, body } = this;
    const mended = {
      HP_Body_SetLinearDamping: [body, 0],
      HP_Body_SetAngularDamping: [body, 0],
      HP_Body_SetActivationControl: [body, api.ActivationControl.ALWAYS_ACTIVE],
      HP_World_SetSpeedLimit: [world, FAST, FAST],
      HP_World_SetIdealStepTime: [world, 0],
    };
    for (const name of SETTINGS) if (mends(setup, name)) checked(api[name](...mended[name]));
  }

  put({ q, w, p, v }) {
    const lever = rotated(q, this.center);
    const place = p.map((x, i) => x - lever[i]);
    checked(this.api.HP_Body_SetQTransform(this.body, [place, [q[1], q[2], q[3], q[0]]]));
    checked(this.api.HP_Body_SetLinearVelocity(this.body, v));
    checked(this.api.HP_Body_SetAngularVelocity(this.body, w));
  }

  state() {
    const [place, [x, y, z, w]] = checked(this.api.HP_Body_GetQTransform(this.body));
    const lever = rotated([w, x, y, z], this.center);
    const v = checked(this.api.HP_Body_GetLinearVelocity(this.body));
    const spin = checked(this.api.HP_Body_GetAngularVelocity(this.body));
    return { q: [w, x, y, z], w: spin, p: place.map((value, i) => value + lever[i]), v };
  }

  step(h, torque) {
    if (torque) checked(this.api.HP_Body_ApplyAngularImpulse(this.body, torque.map((x) => h * x)));
    checked(this.api.HP_World_Step(this.world, h));
  }

  model() {
    const [center, mass, perMass, [x, y, z, w]] = checked(this.api.HP_Body_GetMassProperties(this.body));
    const moments = perMass.map((moment) => mass * moment);
    return { mass, center_of_mass: center, inertia: turnedDiagonal([w, x, y, z], moments) };
  }

  free() {
    checked(this.api.HP_World_RemoveBody(this.world, this.body));
    checked(this.api.HP_Body_Release(this.body));
    checked(this.api.HP_World_Release(this.world));
  }
}

module.exports = { open, description, refused, World };
