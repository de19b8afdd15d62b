// Jolt, compiled to WebAssembly: one body, a sphere that touches nothing. Jolt decides by how fast a
// shape's bounds move whether to put a body to sleep, so that it has to be of the body's size.
'use strict';
const path = require('path');
const { pathToFileURL } = require('url');
const { principal, rotated, turnedDiagonal } = require('./rotations.js');
const { mends } = require('./setups.js');

const FAST = 1e18; // its square is finite in single precision
const NEAR_ZERO = 1e-6; // kg m^2: MotionProperties::SetMassProperties takes no moments of less length
const SWITCHED_OFF = [
  'no gyroscopic force by default (BodyCreationSettings.mApplyGyroscopicForce is set)',
  'mLinearDamping and mAngularDamping of 0.05: v is multiplied by 1 - d h at each step',
  'mMaxAngularVelocity of 47.1 rad/s and mMaxLinearVelocity of 500 m/s',
  'sleep (mAllowSleeping)',
  'the moments 0.4 m that stand in for moments below 1e-6 kg m^2 (MotionProperties.SetInverseInertia gives the right ones)',
];
const SETTINGS = [
  'mApplyGyroscopicForce', 'mLinearDamping', 'mAngularDamping', 'mMaxLinearVelocity', 'mMaxAngularVelocity',
  'mAllowSleeping', 'SetInverseInertia',
];

async function open(folder) {
  const { main } = require(path.join(folder, 'package.json'));
  const { default: start } = await import(pathToFileURL(path.join(folder, main)));
  const api = await start();
  // Vectors are objects of Jolt's own memory: these are filled again and again.
  const scratch = { one: new api.Vec3(), other: new api.Vec3(), place: new api.RVec3(), turn: new api.Quat() };
  return { api, scratch, jolt: physics(api) };
}

// One layer, for one body.
function physics(api) {
  const pairs = new api.ObjectLayerPairFilterTable(1);
  const layers = new api.BroadPhaseLayerInterfaceTable(1, 1);
  layers.MapObjectToBroadPhaseLayer(0, new api.BroadPhaseLayer(0));
  const settings = new api.JoltSettings();
  settings.mMaxBodies = settings.mMaxBodyPairs = settings.mMaxContactConstraints = 16;
  settings.mObjectLayerPairFilter = pairs;
  settings.mBroadPhaseLayerInterface = layers;
  settings.mObjectVsBroadPhaseLayerFilter = new api.ObjectVsBroadPhaseLayerFilterTable(layers, 1, pairs, 1);
  return new api.JoltInterface(settings);
}

function description(api, setup) {
  return {
    name: 'jolt-physics',
    licence: 'MIT',
    precision: 'float32',
    features: ['free', 'gravity', 'torque', 'full_inertia', 'offset_com'],
    integrators: [{
      name: 'step',
      scheme: setup === 'physics' ? 'semi-implicit-euler-rescaled-momentum' : null, // else damped
      order: 1,
      note: 'JoltInterface.Step: L1 = (L - h w x L) |L| / |L - h w x L|, w1 = I^-1 (L1 + h t), and the rotation of h w1',
    }],
    conventions: [
      'quaternions are (x, y, z, w), world-from-body',
      "a body's position is that of its origin, its velocity that of its centre of mass; all velocities are in world axes",
      'the inertia is given as a tensor about the centre of mass, and kept as inverse principal moments and the quaternion of their axes',
      'a torque is in world axes and acts during one step: a torque in body axes is turned at the start of each step',
    ],
    switched_off: setup === 'physics' ? SWITCHED_OFF : [],
    settings: SETTINGS,
    links: [
      'https://github.com/jrouwe/JoltPhysics',
      'https://github.com/jrouwe/JoltPhysics.js',
      'https://github.com/jrouwe/JoltPhysics/issues/803',
    ],
  };
}

const refused = () => '';
const list = (found) => [found.GetX(), found.GetY(), found.GetZ()];

function filled(vector, values) {
  vector.Set(...values);
  return vector;
}

// Settings of a body; those that they point to are copied.
function settingsOf({ api, scratch }, setup, given) {
  const mean = (given.inertia[0] + given.inertia[4] + given.inertia[8]) / 3;
  const sphere = new api.SphereShape(Math.sqrt(2.5 * mean / given.mass)); // with this moment
  const shape = new api.OffsetCenterOfMassShape(sphere, filled(scratch.one, given.center_of_mass));
  const start = [filled(scratch.place, [0, 0, 0]), filled(scratch.turn, [0, 0, 0, 1])];
  const made = new api.BodyCreationSettings(shape, ...start, api.EMotionType_Dynamic, 0);
  made.mOverrideMassProperties = api.EOverrideMassProperties_MassAndInertiaProvided;
  const inertia = api.Mat44.prototype.sIdentity();
  for (const row of [0, 1, 2]) inertia.SetColumn3(row, filled(scratch.one, given.inertia.slice(3 * row, 3 * row + 3)));
  made.mMassPropertiesOverride.mMass = given.mass;
  made.mMassPropertiesOverride.mInertia = inertia;
  const mended = {
    mApplyGyroscopicForce: true,
    mLinearDamping: 0, mAngularDamping: 0,
    mMaxLinearVelocity: FAST, mMaxAngularVelocity: FAST,
    mAllowSleeping: false,
  };
  for (const [name, value] of Object.entries(mended)) if (mends(setup, name)) made[name] = value;
  return made;
}

class World {
  constructor(opened, setup, given, gravity) {
    Object.assign(this, opened);
    const system = this.jolt.GetPhysicsSystem();
    system.SetGravity(filled(this.scratch.one, gravity));
    this.bodies = system.GetBodyInterface();
    const settings = settingsOf(opened, setup, given);
    this.body = this.bodies.CreateBody(settings);
    this.api.destroy(settings);
    if (mends(setup, 'SetInverseInertia')) this.keepSmallMoments(given.inertia);
    this.bodies.AddBody(this.body.GetID(), this.api.EActivation_Activate);
    this.center = list(this.body.GetShape().GetCenterOfMass());
  }

  keepSmallMoments(inertia) {
    const { moments, frame: [w, x, y, z] } = principal(inertia);
    if (Math.hypot(...moments) > 2 * NEAR_ZERO) return; // twice, for the rounding of its square
    const { one, turn } = this.scratch;
    const inverse = [filled(one, moments.map((moment) => 1 / moment)), filled(turn, [x, y, z, w])];
    this.body.GetMotionProperties().SetInverseInertia(...inverse);
  }

  put({ q, w, p, v }) {
    const { one, other, place, turn } = this.scratch;
    const lever = rotated(q, this.center);
    filled(place, p.map((x, i) => x - lever[i]));
    filled(turn, [q[1], q[2], q[3], q[0]]);
    const id = this.body.GetID();
    this.bodies.SetPositionAndRotation(id, place, turn, this.api.EActivation_Activate);
    this.bodies.SetLinearAndAngularVelocity(id, filled(one, v), filled(other, w));
  }

  state() {
    const turn = this.body.GetRotation();
    const q = [turn.GetW(), turn.GetX(), turn.GetY(), turn.GetZ()];
    const p = list(this.body.GetCenterOfMassPosition());
    return { q, w: list(this.body.GetAngularVelocity()), p, v: list(this.body.GetLinearVelocity()) };
  }

  step(h, torque) {
    if (torque) this.body.AddTorque(filled(this.scratch.one, torque));
    this.jolt.Step(h, 1);
  }

  model() {
    const held = this.body.GetMotionProperties();
    const moments = list(held.GetInverseInertiaDiagonal()).map((x) => 1 / x);
    const turn = held.GetInertiaRotation();
    const frame = [turn.GetW(), turn.GetX(), turn.GetY(), turn.GetZ()];
    return { mass: 1 / held.GetInverseMass(), center_of_mass: this.center, inertia: turnedDiagonal(frame, moments) };
  }

  free() {
    const id = this.body.GetID();
    this.bodies.RemoveBody(id);
    this.bodies.DestroyBody(id);
  }
}

module.exports = { open, description, refused, World };
