// cannon-es: a world of one body, whose shape is a point. There is no gyroscopic term.
'use strict';
const { mends } = require('./setups.js');

const SWITCHED_OFF = [
  'linearDamping and angularDamping of 0.01: v is multiplied by (1 - d)^h at each step',
];
const SETTINGS = ['linearDamping', 'angularDamping'];

async function open(folder) {
  return require(folder);
}

function description(api, setup) {
  return {
    name: 'cannon-es',
    licence: 'MIT',
    precision: 'float64',
    features: ['free', 'gravity', 'torque', 'offset_com'],
    integrators: [{
      name: 'step',
      order: 1,
      note: "World.step: w1 = w + h R I^-1 R^T t in world axes, without omega x I omega; q1 = q + h/2 (0, w1) q, made unit",
    }],
    conventions: [
      'quaternions are (x, y, z, w), world-from-body',
      'positions and velocities are those of the centre of mass, from which shapes are placed; all velocities are in world axes',
      "the inertia has three numbers, in body axes: no products",
      'no gyroscopic term: a step without torque keeps omega in world axes, where the motion keeps the angular momentum',
      'a torque is in world axes and acts during one step: a torque in body axes is turned at the start of each step',
    ],
    switched_off: setup === 'physics' ? SWITCHED_OFF : [],
    settings: SETTINGS,
    links: ['https://github.com/pmndrs/cannon-es', 'https://github.com/pmndrs/cannon-es/blob/master/src/objects/Body.ts'],
  };
}

function refused({ inertia }) {
  const products = [1, 2, 3, 5, 6, 7].some((i) => inertia[i] !== 0);
  return products ? 'cannon-es keeps three moments of inertia in body axes, and no products' : '';
}

class World {
  constructor({ World: CannonWorld, Body, Particle, Vec3 }, setup, given, gravity) {
    const { mass, center_of_mass: center, inertia } = given;
    this.world = new CannonWorld({ gravity: new Vec3(...gravity) });
    const damping = Object.fromEntries(SETTINGS.filter((name) => mends(setup, name)).map((name) => [name, 0]));
    this.body = new Body({ mass, ...damping });
    this.body.addShape(new Particle(), new Vec3(...center).negate()); // sets the inertia as well
    this.body.inertia.set(inertia[0], inertia[4], inertia[8]);
    this.body.invInertia.set(1 / inertia[0], 1 / inertia[4], 1 / inertia[8]);
    this.world.addBody(this.body);
    this.turn = new Vec3();
  }

  put({ q, w, p, v }) {
    this.body.quaternion.set(q[1], q[2], q[3], q[0]);
    this.body.angularVelocity.set(...w);
    this.body.position.set(...p);
    this.body.velocity.set(...v);
    this.body.updateInertiaWorld(true);
  }

  state() {
    const { quaternion: q, angularVelocity: w, position: p, velocity: v } = this.body;
    return { q: [q.w, q.x, q.y, q.z], w: w.toArray(), p: p.toArray(), v: v.toArray() };
  }

  step(h, torque) {
    if (torque) this.body.applyTorque(this.turn.set(...torque));
    this.world.step(h);
  }

  model() {
    const { x, y, z } = this.body.inertia;
    const center = this.body.shapeOffsets[0].negate().toArray();
    return { mass: this.body.mass, center_of_mass: center, inertia: [x, 0, 0, 0, y, 0, 0, 0, z] };
  }

  free() {}
}

module.exports = { open, description, refused, World };
