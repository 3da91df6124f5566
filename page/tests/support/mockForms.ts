// Forms of the stand-in for `durer view`: each type of parameter once.
import type { Form, Param } from "../../src/live/protocol";

const param = (name: string, type: string, more: Partial<Param> = {}): Param =>
  ({ name, type, doc: `What ${name} does.`, unit: "", default: null, value: null, min: null, max: null, words: null, editable: true, ...more });
const form = (id: string, title: string, family: string, kind: string, kinds: string[], params: Param[]): Form => ({ id, title, family, kind, kinds, params, changed: false });

export function mockForms(): Form[] {
  return [
    form("look", "look", "look", "look", [], [
      param("exposure", "float", { unit: "EV", default: 0, min: -10, max: 10 }),
      param("tonemap", "choice", { default: "none", words: ["none", "agx", "pbr-neutral"] }),
    ]),
    form("film", "film", "film", "film", [], [
      param("width", "int", { default: 320, value: 320, min: 1, max: 65536 }), param("height", "int", { default: 180, value: 180, min: 1, max: 65536 }),
      param("samples", "int", { default: 8, min: 1, max: 1048576 }), param("seed", "int", { default: 0, min: 0 }),
    ]),
    form("moment", "moment", "moment", "moment", [], [param("time", "float", { unit: "s", default: 0, min: 0, max: 2 })]),
    form("integrator", "integrator", "integrator", "whitted", ["cast", "whitted", "distributed", "path"], [
      param("maxdepth", "int", { default: 5, min: 0, max: 100 }), param("mincontribution", "float", { default: 0.002, min: 0, max: 1 }),
      param("roulette", "bool", { default: true }),
    ]),
    form("sampler", "sampler", "sampler", "zsobol", ["zsobol", "independent"], []),
    form("camera", "camera", "camera", "perspective", ["perspective", "orthographic"], [param("fov", "float", { unit: "deg", default: 90, value: 36, min: 1, max: 179 })]),
    form("material/0", "red", "material", "diffuse", ["diffuse", "conductor", "dielectric"], [
      param("reflectance", "color-texture", { default: [0.5, 0.5, 0.5], value: [0.8, 0.1, 0.1], min: 0, max: 1 }),
      param("roughness", "float-texture", { default: 0, value: { texture: "grain" }, min: 0, max: 1 }),
      param("eta", "index", { default: 1.5, value: { spectrum: "glass-BK7" } }),
      param("alpha", "float", { default: 1, min: 0 }), param("normalmap", "file", { editable: false }),
    ]),
    form("material/1", "floor", "material", "diffuse", ["diffuse", "conductor"], [param("reflectance", "color-texture", { default: [0.5, 0.5, 0.5], value: { texture: "wood" } })]),
    form("light/0", "sun", "light", "distant", ["distant", "point"], [
      param("L", "color", { default: [1, 1, 1], value: { blackbody: 5500 } }), param("from", "point3", { default: [0, 0, 0], value: [0, 5, 0], unit: "m" }),
      param("scale", "float", { default: 1, value: 2 }),
    ]),
  ];
}
