// /// finding
// engine = "physx-js-webidl"
// integrator = "step"
// scenario = "sphere"
// setup = "as-shipped"
// timestep = 0.01
// metric = "trajectory/omega/error_max"
// kind = "default"
// reach = "ordinary"
// title = "Omega is damped"
// what = "A sphere that nothing touches loses a fifth of its omega in 5 s."
// why = "angularDamping is 0.05: omega is multiplied by 1 - 0.05 h at each step."
// mends = "setAngularDamping(0)"
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

// How much of omega is lost in 5 s.
function lost(step, omega) {
  for (let n = 0; n < 500; n += 1) step(0.01);
  return Math.hypot(omega()[0] - 1, omega()[1] - 2, omega()[2] - 3) / Math.hypot(1, 2, 3);
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
  const sphere = (mend) => {
    const body = make(api, own, [0.4, 0.4, 0.4], [0.5, -0.25, 0.125], [1, 2, 3], mend);
    return lost((h) => step(own.scene, h), () => list(body.getAngularVelocity()));
  };
  console.log('release', release);
  console.log('figure', sphere(nothing));
  console.log('mended', sphere((body) => body.setAngularDamping(0)));
});
