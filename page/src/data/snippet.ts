// A unit test in Rust that traces the sample again and checks the numbers of one ray.
import type { Node, Tree } from "./types";

/** A Rust string literal. */
function quoted(text: string): string {
  return `"${text.replace(/[\\"]/g, "\\$&").replace(/\n/g, "\\n")}"`;
}

function float(x: number): string {
  if (!Number.isFinite(x)) return Number.isNaN(x) ? "f32::NAN" : x > 0 ? "f32::INFINITY" : "f32::NEG_INFINITY";
  const text = String(x);
  return /[.e]/.test(text) ? text : `${text}.0`;
}

const array = (v: number[]): string => `[${v.map(float).join(", ")}]`;

/** The name of the test: a sentence, as the project's tests have. */
function name(tree: Tree, node: Node): string {
  const words = `ray ${node.id} of pixel ${tree.pixel.join(" ")} ${node.kind} is as recorded`;
  return words.replace(/[^a-z0-9]+/gi, "_").toLowerCase();
}

/** The test's text. */
export function unitTest(tree: Tree, node: Node): string {
  const rules = tree.rules ?? {};
  const options = [
    `integrator: Some(${quoted(tree.integrator)}.to_owned())`,
    `width: Some(${tree.width})`,
    `height: Some(${tree.height})`,
    ...(typeof tree.samples === "number" ? [`samples: Some(${tree.samples})`] : []),
    ...(typeof rules["max_depth"] === "number" ? [`max_depth: Some(${rules["max_depth"]})`] : []),
    ...(typeof rules["min_contribution"] === "number" ? [`min_contribution: Some(${float(rules["min_contribution"])})`] : []),
  ];
  const facts = [
    `    assert_eq!(ray.kind.word(), ${quoted(node.kind)});`,
    ...(node.parent === null ? [] : [`    assert_eq!(ray.parent, Some(${node.parent}));`]),
    ...(node.t === null ? [] : [`    near(&[ray.length().expect("a hit")], &[${float(node.t)}]);`]),
    `    near(&Basis::Rgb.to_rgb(ray.weight), &${array(node.weight)});`,
    `    near(&Basis::Rgb.to_rgb(ray.throughput), &${array(node.throughput)});`,
    `    near(&Basis::Rgb.to_rgb(ray.local), &${array(node.local)});`,
    `    near(&Basis::Rgb.to_rgb(ray.result), &${array(node.result)});`,
    `    assert_eq!(ray.stop.map(|stop| stop.word()), ${node.stop ? `Some(${quoted(node.stop)})` : "None"});`,
  ];
  return `use durer::{Options, prepare, spectrum::Basis};

/// The numbers agree within one part in 100 000.
fn near(found: &[f32], expected: &[f32]) {
    let close = |(a, b): (&f32, &f32)| (a - b).abs() <= 1e-5 * (1.0 + b.abs());
    assert!(found.iter().zip(expected).all(close), "{found:?} != {expected:?}");
}

#[test]
fn ${name(tree, node)}() {
    let options = Options {
${options.map((line) => `        ${line},`).join("\n")}
        ..Options::default()
    };
    let prepared = prepare(&mut durer::open(${quoted(tree.scene)}), &options).expect("the scene compiles");
    let (tree, _) = prepared.job().record(${JSON.stringify(tree.pixel).replace(",", ", ")}, ${tree.sample});
    let ray = &tree.nodes[${node.id}];
${facts.join("\n")}
}
`;
}
