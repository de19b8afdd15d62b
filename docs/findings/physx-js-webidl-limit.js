// /// finding
// engine = "physx-js-webidl"
// integrator = "step"
// scenario = "docs/findings/fast-sphere.toml"
// setup = "as-shipped"
// timestep = 0.002
// kind = "default"
// reach = "extreme"
// metric = "trajectory/omega/error_max"
// title = "Omega is cut to 100 rad/s"
// what = "Of 150 rad/s a body keeps 100 rad/s, less what damping takes."
// why = "maxAngularVelocity is 100 rad/s."
// mends = "setMaxAngularVelocity(1e18); setAngularDamping(0)"
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
  const missing = (mend) => {
    const body = make(api, own, [0.4, 0.4, 0.4], [600, 0, 0], [0, 0, 150], mend);
    for (let n = 0; n < 20; n += 1) step(own.scene, 0.002);
    return Math.abs(body.getAngularVelocity().z / 150 - 1);
  };
  console.log('release', release);
  console.log('figure', missing(nothing));
  console.log('mended', missing((body) => {
    body.setMaxAngularVelocity(1e18);
    body.setAngularDamping(0);
  }));
});
