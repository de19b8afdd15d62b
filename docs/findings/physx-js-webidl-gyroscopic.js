// /// finding
// engine = "physx-js-webidl"
// integrator = "step"
// setup = "as-shipped"
// scenario = "docs/findings/brick.toml"
// timestep = 0.01
// metric = "invariants/angular_momentum/drift_full"
// kind = "default"
// reach = "ordinary"
// title = "The gyroscopic term is off"
// what = "A brick that nothing touches keeps the direction of its omega, so that its angular momentum turns with it; a T-handle never flips."
// why = "The flag eENABLE_GYROSCOPIC_FORCES is not set, and this package has no name for it. Damping takes a tenth of omega besides."
// mends = "setRigidBodyFlag(1 << 10, true); setAngularDamping(0)"
// link = "https://nvidia-omniverse.github.io/PhysX/physx/5.6.1/index.html"
// ///
'use strict';
const fs = require('fs');
const path = require('path');
const { pathToFileURL } = require('url');

const [root] = require.resolve.paths('physx-js-webidl').filter((one) => fs.existsSync(path.join(one, 'physx-js-webidl')));
const folder = path.join(root, 'physx-js-webidl');
const wasmBinary = fs.readFileSync(path.join(folder, 'physx-js-webidl.wasm'));
const release = JSON.parse(fs.readFileSync(path.join(folder, 'package.json'))).version;

// The package is built for browsers, and looks for the names of one while it starts.
function started({ default: start }) {
  const { process } = globalThis;
  Object.assign(globalThis, { process: undefined, window: globalThis });
  try {
    return start({ wasmBinary });
  } finally {
    globalThis.process = process;
    delete globalThis.window;
  }
}

const MOMENTS = [1, 2, 2.5];
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

function sceneOf(api) {
  const own = api.PxTopLevelFunctions.prototype;
  const foundation = own.CreateFoundation(own.PHYSICS_VERSION, new api.PxDefaultAllocator(), new api.PxDefaultErrorCallback());
  const scale = new api.PxTolerancesScale();
  const physics = own.CreatePhysics(own.PHYSICS_VERSION, foundation, scale);
  const settings = new api.PxSceneDesc(scale);
  settings.cpuDispatcher = own.DefaultCpuDispatcherCreate(0);
  settings.filterShader = own.DefaultFilterShader();
  return { physics, scene: physics.createScene(settings) };
}
function make(api, { physics, scene }, moments, v, omega, mend) {
  const vector = ([x, y, z]) => new api.PxVec3(x, y, z);
  const body = physics.createRigidDynamic(new api.PxTransform(vector([0, 0, 0]), new api.PxQuat(0, 0, 0, 1)));
  body.setMass(1);
  body.setMassSpaceInertiaTensor(vector(moments));
  mend(body);
  scene.addActor(body);
  body.setLinearVelocity(vector(v));
  body.setAngularVelocity(vector(omega));
  return body;
}
function step(scene, h) {
  scene.simulate(h);
  scene.fetchResults(true);
}
const list = ({ x, y, z }) => [x, y, z];
const nothing = () => {};

import(pathToFileURL(path.join(folder, 'physx-js-webidl.mjs'))).then(started).then((api) => {
  const own = sceneOf(api);
  const brick = (mend) => {
    const body = make(api, own, MOMENTS, [0, 0, 0], [1, 2, 3], mend);
    const turn = () => body.getGlobalPose().q;
    return drift((h) => step(own.scene, h), () => [[...list(turn()), turn().w], list(body.getAngularVelocity())]);
  };
  console.log('release', release);
  console.log('figure', brick(nothing));
  console.log('mended', brick((body) => {
    body.setRigidBodyFlag(1 << 10, true);
    body.setAngularDamping(0);
  }));
});
