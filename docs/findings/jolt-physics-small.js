// /// finding
// engine = "jolt-physics"
// integrator = "step"
// setup = "as-shipped"
// scenario = "docs/findings/tiny-brick.toml"
// timestep = 0.01
// metric = "model/model/inertia"
// kind = "wrong field"
// reach = "extreme"
// title = "Small moments of inertia are replaced"
// what = "A brick of 5 g with moments of 1e-7 to 2.5e-7 kg m^2 holds 2e-3 kg m^2 about every axis, and nothing is reported."
// why = "Below 1e-6 kg m^2 the moments count as zero, and those of a sphere of 1 m, 0.4 m about each axis, stand in for them."
// mends = "body.GetMotionProperties().SetInverseInertia(diagonal, rotation)"
// link = "https://github.com/jrouwe/JoltPhysics/blob/master/Jolt/Physics/Body/MotionProperties.inl"
// ///
'use strict';
const fs = require('fs');
const path = require('path');
const { pathToFileURL } = require('url');

const [root] = require.resolve.paths('jolt-physics').filter((one) => fs.existsSync(path.join(one, 'jolt-physics')));
const folder = path.join(root, 'jolt-physics');
const about = JSON.parse(fs.readFileSync(path.join(folder, 'package.json')));

const [MOMENTS, RADIUS] = [[1e-7, 2e-7, 2.5e-7], 0.1];

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
  const apart = (mended) => {
    const [, body] = make(api, 0.005, MOMENTS, [0, 0, 0], [1, 2, 3], {});
    const held = body.GetMotionProperties();
    if (mended) held.SetInverseInertia(new api.Vec3(...MOMENTS.map((moment) => 1 / moment)), new api.Quat(0, 0, 0, 1));
    const gaps = list(held.GetInverseInertiaDiagonal()).map((inverse, i) => Math.abs(1 / inverse - MOMENTS[i]));
    return Math.max(...gaps) / Math.max(...MOMENTS);
  };
  console.log('release', about.version);
  console.log('figure', apart(false));
  console.log('mended', apart(true));
});
