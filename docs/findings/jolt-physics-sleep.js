// /// finding
// engine = "jolt-physics"
// integrator = "step"
// setup = "as-shipped"
// scenario = "docs/findings/slow-sphere.toml"
// timestep = 0.01
// metric = "trajectory/position/error_max"
// reach = "extreme"
// kind = "default"
// title = "Slow bodies are put to sleep"
// what = "A body at 0.02 m/s in free space stops after half a second."
// why = "mAllowSleeping is true. Damping acts until then."
// mends = "mAllowSleeping = false; mLinearDamping = 0"
// link = "https://github.com/jrouwe/JoltPhysics/blob/master/Jolt/Physics/Body/BodyCreationSettings.h"
// ///
'use strict';
const fs = require('fs');
const path = require('path');
const { pathToFileURL } = require('url');

const [root] = require.resolve.paths('jolt-physics').filter((one) => fs.existsSync(path.join(one, 'jolt-physics')));
const folder = path.join(root, 'jolt-physics');
const about = JSON.parse(fs.readFileSync(path.join(folder, 'package.json')));

const RADIUS = 1;

function make(api, mass, moments, v, omega, mended) {
  const layers = new api.BroadPhaseLayerInterfaceTable(1, 1);
  layers.MapObjectToBroadPhaseLayer(0, new api.BroadPhaseLayer(0));
  const settings = new api.JoltSettings();
  settings.mObjectLayerPairFilter = new api.ObjectLayerPairFilterTable(1);
  settings.mBroadPhaseLayerInterface = layers;
  settings.mObjectVsBroadPhaseLayerFilter = new api.ObjectVsBroadPhaseLayerFilterTable(layers, 1, settings.mObjectLayerPairFilter, 1);
  const jolt = new api.JoltInterface(settings);
  jolt.GetPhysicsSystem().SetGravity(new api.Vec3(0, 0, 0));
  const bodies = jolt.GetPhysicsSystem().GetBodyInterface();
  const shape = new api.SphereShape(RADIUS);
  const own = new api.BodyCreationSettings(shape, new api.RVec3(0, 0, 0), new api.Quat(0, 0, 0, 1), api.EMotionType_Dynamic, 0);
  own.mOverrideMassProperties = api.EOverrideMassProperties_MassAndInertiaProvided;
  const inertia = api.Mat44.prototype.sIdentity();
  moments.forEach((moment, i) => inertia.SetColumn3(i, new api.Vec3(...[0, 1, 2].map((j) => (i === j ? moment : 0)))));
  own.mMassPropertiesOverride.mMass = mass;
  own.mMassPropertiesOverride.mInertia = inertia;
  Object.assign(own, mended);
  const body = bodies.CreateBody(own);
  bodies.AddBody(body.GetID(), api.EActivation_Activate);
  bodies.SetLinearAndAngularVelocity(body.GetID(), new api.Vec3(...v), new api.Vec3(...omega));
  return [jolt, body];
}
const list = (vector) => [vector.GetX(), vector.GetY(), vector.GetZ()];

import(pathToFileURL(path.join(folder, about.main))).then(({ default: start }) => start()).then((api) => {
  const behind = (mended) => {
    const [jolt, body] = make(api, 1, [0.4, 0.4, 0.4], [0.02, 0, 0], [0, 0, 0.02], mended);
    for (let n = 0; n < 500; n += 1) jolt.Step(0.01, 1);
    return Math.abs(body.GetPosition().GetX() - 0.1);
  };
  console.log('release', about.version);
  console.log('figure', behind({}));
  console.log('mended', behind({ mAllowSleeping: false, mLinearDamping: 0 }));
});
