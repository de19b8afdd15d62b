// PhysX in single precision, compiled to WebAssembly: one body without a shape in a scene.
'use strict';
const fs = require('fs');
const path = require('path');
const { pathToFileURL } = require('url');
const { principal, rotated, turnedDiagonal } = require('./rotations.js');
const { mends } = require('./setups.js');

const FAST = 1e18; // its square, which PhysX keeps, is finite in single precision
const GYROSCOPIC = 1 << 10; // PxRigidBodyFlag::eENABLE_GYROSCOPIC_FORCES, which the binding does not name
const SWITCHED_OFF = [
  'no gyroscopic force by default (PxRigidBodyFlag::eENABLE_GYROSCOPIC_FORCES, 1 << 10, is set)',
  'angularDamping of 0.05: omega is multiplied by 1 - d h at each step',
  'maxAngularVelocity of 100 rad/s',
  'sleep (setSleepThreshold)',
];
const SETTINGS = ['eENABLE_GYROSCOPIC_FORCES', 'angularDamping', 'maxAngularVelocity', 'sleepThreshold'];

async function open(folder) {
  const file = path.join(folder, 'physx-js-webidl.mjs');
  const { default: start } = await import(pathToFileURL(file));
  const wasmBinary = fs.readFileSync(path.join(folder, 'physx-js-webidl.wasm'));
  const api = await asInBrowser(() => start({ wasmBinary }));
  // Vectors are objects of the program's own memory: these are filled again and again.
  const { PxQuat, PxTransform, PxVec3 } = api;
  const scratch = { vector: new PxVec3(), pose: new PxTransform(), place: new PxVec3(), turn: new PxQuat() };
  return { api, scratch, ...sceneOf(api) };
}

// The package is built for browsers and refuses Node, by the names that it finds. It looks for them
// before its first wait, so that they are hidden during this call only.
function asInBrowser(start) {
  const { process } = globalThis;
  try {
    globalThis.process = undefined;
    globalThis.window = globalThis;
    return start();
  } finally {
    globalThis.process = process;
    delete globalThis.window;
  }
}

function sceneOf(api) {
  const own = api.PxTopLevelFunctions.prototype;
  const [allocator, reporter] = [new api.PxDefaultAllocator(), new api.PxDefaultErrorCallback()];
  const foundation = own.CreateFoundation(own.PHYSICS_VERSION, allocator, reporter);
  const scale = new api.PxTolerancesScale();
  const physics = own.CreatePhysics(own.PHYSICS_VERSION, foundation, scale);
  const settings = new api.PxSceneDesc(scale);
  settings.cpuDispatcher = own.DefaultCpuDispatcherCreate(0);
  settings.filterShader = own.DefaultFilterShader();
  return { physics, scene: physics.createScene(settings) };
}

// Without torque a step is a scheme of the reference. Torque pushes omega before its momentum is
// turned, which none of the reference does; as shipped the body is damped.
function description(opened, setup, driven) {
  return {
    name: 'physx-js-webidl',
    licence: 'MIT AND BSD-3-Clause', // of the binding, and of PhysX in it
    precision: 'float32',
    features: ['free', 'gravity', 'torque', 'full_inertia', 'offset_com'],
    integrators: [{
      name: 'step',
      scheme: setup === 'physics' && !driven ? 'semi-implicit-euler-rescaled-momentum' : null,
      order: 1,
      note: 'PxScene.simulate: w = w0 + h I^-1 t, L = I w, w1 = I^-1 (L - h w x L) |L| / |L - h w x L|, and the rotation of h w1',
    }],
    conventions: [
      'quaternions are (x, y, z, w), world-from-body',
      "an actor's pose is that of its origin, its linear velocity that of its centre of mass; all velocities are in world axes",
      'the inertia is three principal moments about the centre of mass, along the axes of the pose CMassLocalPose',
      'a torque is in world axes and acts during one step: a torque in body axes is turned at the start of each step',
    ],
    switched_off: setup === 'physics' ? SWITCHED_OFF : [],
    settings: SETTINGS,
    links: [
      'https://github.com/fabmax/physx-js-webidl',
      'https://github.com/NVIDIA-Omniverse/PhysX',
      'https://nvidia-omniverse.github.io/PhysX/physx/5.6.1/index.html',
    ],
  };
}

const refused = () => '';
const list = ({ x, y, z }) => [x, y, z];

class World {
  constructor(opened, setup, given, gravity) {
    Object.assign(this, opened);
    this.scene.setGravity(this.vector(gravity));
    const { moments, frame } = principal(given.inertia);
    this.body = this.physics.createRigidDynamic(this.pose([1, 0, 0, 0], [0, 0, 0]));
    this.body.setCMassLocalPose(this.pose(frame, given.center_of_mass));
    this.body.setMass(given.mass);
    this.body.setMassSpaceInertiaTensor(this.vector(moments));
    if (mends(setup, 'eENABLE_GYROSCOPIC_FORCES')) this.body.setRigidBodyFlag(GYROSCOPIC, true);
    if (setup === 'physics') this.body.setLinearDamping(0); // as it is by default
    if (mends(setup, 'angularDamping')) this.body.setAngularDamping(0);
    if (mends(setup, 'maxAngularVelocity')) this.body.setMaxAngularVelocity(FAST);
    if (mends(setup, 'sleepThreshold')) this.body.setSleepThreshold(0);
    this.scene.addActor(this.body);
    this.center = list(this.body.getCMassLocalPose().p);
  }

  vector([x, y, z]) {
    const { vector } = this.scratch;
    [vector.x, vector.y, vector.z] = [x, y, z];
    return vector;
  }

  pose([w, x, y, z], place) {
    const { pose, turn } = this.scratch;
    [turn.x, turn.y, turn.z, turn.w] = [x, y, z, w];
    [pose.q, pose.p] = [turn, this.vector(place)];
    return pose;
  }

  put({ q, w, p, v }) {
    const lever = rotated(q, this.center);
    this.body.setGlobalPose(this.pose(q, p.map((x, i) => x - lever[i])));
    this.body.setLinearVelocity(this.vector(v));
    this.body.setAngularVelocity(this.vector(w));
  }

  state() {
    const pose = this.body.getGlobalPose();
    const { x, y, z, w } = pose.q;
    const place = list(pose.p);
    const lever = rotated([w, x, y, z], this.center);
    const p = place.map((value, i) => value + lever[i]);
    return { q: [w, x, y, z], w: list(this.body.getAngularVelocity()), p, v: list(this.body.getLinearVelocity()) };
  }

  step(h, torque) {
    if (torque) this.body.addTorque(this.vector(torque));
    this.scene.simulate(h);
    this.scene.fetchResults(true);
  }

  model() {
    const pose = this.body.getCMassLocalPose();
    const { x, y, z, w } = pose.q;
    const inertia = turnedDiagonal([w, x, y, z], list(this.body.getMassSpaceInertiaTensor()));
    return { mass: this.body.getMass(), center_of_mass: this.center, inertia };
  }

  free() {
    this.scene.removeActor(this.body);
    this.body.release();
  }
}

module.exports = { open, description, refused, World };
