//! Primitives packed by Draco (KHR_draco_mesh_compression). The streams were made by Google's encoder 1.5.7 (draco3dgltf)
//! from the numbers that the tests compute, with 14, 10 and 12 bits for positions, normals and texture coordinates.
mod gltf_document;

use base64::{Engine, engine::general_purpose::STANDARD};
use durer_io::import::Imported;
use durer_scene::{Mesh, Severity};
use gltf_document::{first, import, import_well};
use serde_json::{Value, json};

/// Connected triangle by triangle, each by what it shares with the one before.
const EDGES: &str = "RFJBQ08CAgEBAAAAdcABBMABBwA177qu69OqqupTraqq6lPVqqqq6lNVraqqqupTVdWqqqqq6lNVVa2qqqqq6lNVVdWqqqqqqhr/ARH/Aphe/wKYXv8CmF7/ApheBf8AAAAAAAEAAAIAAAMAAAEACQMAAAIBAQkDAAEDAQMJAgACAgECAgQAAwEBBAQEAAQBAQEBAQWAgAGlLAECSQH////////////////////zXP////////////////////cwvQT////////////////////3MBkB////////////////////7zAwA0kB////////////////////92EC6P////////////////////u8////////////////////93kD/////////////////////zD/////////////////////////////////////////////////////////////////////////////////////////////////////////////////////////////////////////////////////////////////////////9zBVvXvhs4oSJ5L/9hY+V/gj0IvUdrzwwMPzeMZZnX90DDtISc9HuzaD1OGVQYZOQev04yIvnezmRs50PewR3KGbkRpc/Ra+gxPX7do9EFhstBOP9u9vgAAAAAD/PwAAAAAAAAAAAAAAAAAAAACAQA4GAwEACxOMMQK9Au0EMQJtMxMWCyIFOTtUQNCuMKc2eFIocq2DJ2Cuvi+m76y3O+kL4fwdZFejMgqKjC7F7sSI3Tu3kWvphNc8Nm/FOR5fdPSjB/4D7Qx4H77nLaBfejeE6x2480Q/sT7prVf8FqVIWjnvp1N0oN+68kEojYP+gQvQiBQ39QL4vsz6HI1N/vGsi3B4GsCMc9MCRV2gtURrj1/F8SLE78NXgztaUSD78C84ZDYVqwtfw9PHP3L8O+vrs/3qQuPddNq2A2O+44couusJ92o+T9c45r+9c7vzGGyX+GuC9RGsrugZSElTWgDg1jmwbrtRhr39YHTs63jeV/BlUE7V/Je/jjjk6+/+j/ecKKQhoZu7QByvp/z6GrFE/CdgH3dTXOtzt+83iC8+Em/XsgXX80cw/xf/AwAA/wEAAPkFmmabDYEKBQEBAA0DjBOMaRDVICENA4wap6YPnkjICTSq2br7oc7A/ii2qaxm5KOn3k+q+v+p/p++tWmfqieboiARgKd9qp2k820c096/4u31ZCF+tU8pF8VAAXjaX2HPWe91Zn/UCHqmb23a5+h/UtBl3wCYeRmAKcBxAJsCIBHADIB6AqxS0OXeIo5Jk5Hp9fK/cRvTxjHt/yvevueVbmveDShqxuPotmYAowAu5B6XDg+gRACe9p4AywPI85l6s5B7HLo8gJuiIBEAu5enPQCa1cMDANqfCACgqoLCntefCACg/YkAoFk9PACg/QHwEED6Fjplbklc47+/o+95o9vvAN0YWtJrOm/Dn1fYy+ep/KO5t+bd+5R6YQyAqgAwDoCqAKjqaQnKmz/EIM+Hg4AiiiUgEnMAAAABAtFIAAAAAP8PAAAAAAAAAAAAAAAAgD8MAQEBAQTxAZEv2Ql5BQckCyRXJBckSyQk/4sk/zskSIwKDu8CrTXyUgpciSBxkWPDfgGhczmQu52RY8N+Af+JTRU60rhljIzAm5t3f9Qqb3HY4shlpslL6y5ztb5PZ+ev1MTK/PGPhAAAAAD/AAAAAQEBAQMRCT9oJBNIGyQLDsPHK927+ursj4AAAAAAFAAAAA==";
/// Corners and values one after another.
const SEQUENCE: &str = "RFJBQ08CAgEAAADAAXUBAAENDQEOAQIODgIPAgMPDwMQAwQQEAQRBAUREQUSBQYSEgYTBgcTEwcUBwgUFAgVCAkVFQkWCQoWFgoXCgsXFwsYCwwYGAwZDQ4aGg4bDg8bGw8cDxAcHBAdEBEdHREeERIeHhIfEhMfHxMgExQgIBQhFBUhIRUiFRYiIhYjFhcjIxckFxgkJBglGBklJRkmGhsnJxsoGxwoKBwpHB0pKR0qHR4qKh4rHh8rKx8sHyAsLCAtICEtLSEuISIuLiIvIiMvLyMwIyQwMCQxJCUxMSUyJSYyMiYzJyg0NCg1KCk1NSk2KSo2Nio3Kis3Nys4Kyw4OCw5LC05OS06LS46Oi47Li87Oy88LzA8PDA9MDE9PTE+MTI+PjI/MjM/PzNANDVBQTVCNTZCQjZDNjdDQzdENzhERDhFODlFRTlGOTpGRjpHOjtHRztIOzxISDxJPD1JST1KPT5KSj5LPj9LSz9MP0BMTEBNQUJOTkJPQkNPT0NQQ0RQUERRREVRUUVSRUZSUkZTRkdTU0dUR0hUVEhVSElVVUlWSUpWVkpXSktXV0tYS0xYWExZTE1ZWU1aTk9bW09cT1BcXFBdUFFdXVFeUVJeXlJfUlNfX1NgU1RgYFRhVFVhYVViVVZiYlZjVldjY1dkV1hkZFhlWFllZVlmWVpmZlpnW1xoaFxpXF1paV1qXV5qal5rXl9ra19sX2BsbGBtYGFtbWFuYWJubmJvYmNvb2NwY2RwcGRxZGVxcWVyZWZycmZzZmdzc2d0AQUACQMAAAEJAwABAwkCAAICAgQAAwQEBAAEAgMCAQEAAQEBBYNAjRf////////////////////3vQLtAv////////////////////OlATECPRT////////////////////36NUB////////////////////8zB1AQEC////////////////////9xkBGQH////////////////////3XFz//////////////////////////////////////////wN1AXkzSFhTqQWB6sCwRfEL2g07nZhs6z7kK4x93/NdWChWQoApl1TMoR6gTtMAFx/YhrDqz4dMADg3i1mkE5O6az6Jg9tkaWPsQYAihiWRfAWPDSa8XECZ0+URBs8Corjg1EpZVPJ9bOk4A2gsvxni+l6iQevIhOFNGnKKAAAAAP8/AAAAAwEACw8xAm0W7QQLeSIYsPstVgb588b0v0mrCFjyV79QxD3HW66Bk8sjf/7v5//+/evfn3795tOfl1UUQQRN29Fsw6//+/mvn3/6+Jtvv/j1d5WTPdRA88Uz2e/vv/7+6et/fv7h58/9/SPiDTa2UALJy1uv33/6/ZvPv/j7b8+/9fqnBTl0kocVVHzMjvoAlA+A+ABwD0D1ADAPwAyowAh0oEEFU4PT//r9p8+/+fuLz//2+ltfpANJ+sjCCvry1vu/v//6+qef//n5h38/98hovMHFEkogz2TrD3/+7+e/Pv7p229+/eKrnvKxhhpYfzTb+cuf//v3v3//+vWnT7/5KyuLKIIGWgP/AwAA/wEAAAABAQEDgAjNHUgxAv////////////+bJRYDZQf//////z9IA+0BN0DHR0Qv1hgkMSL3OehrwffCk+bH4hOrEaogzS+AgZ1S/F2OjjZSKC6sXzQTLEefhBHNqBjuhoEAAAAA/w8AAAABAQEFqAHxEOkOpQEDpQEDpQEDpQEDpQEDpQEDpQEDpQEXJBkBGxkBG8UOFyQvGQEnJFskWyRbJFsksgHcX3DaEGzM9OAlAMkw2hBszEf9vgiWhGADY/R3vJbIx3AQA2P0f4z1q1knd/OtTlMtyF4HEFvbdQ5TieWkSBJaC+F+5UIyqGJlJyAgf+Woh9+XNaT/uwnMLlK1W0Pn/rsJzC5o05CaHZ90LVcQwcP6+MJpkB5XEGlVsbgu3AXupsCpYPjywo+17abAqWpGtvaMNTHAQDPsiVmPTDUxwEAzh7Q87sTR0dHR0dHR0dHRgHOJAAAAAP8AAAAAAQEBAxUxHwOhHjsZAQMZAUpkjbm09ZyqdfrfF9amFxYNCXWlAF/71UkUsQFf+823NfOnF6bNs8KYAZimzbOm+yTKQu+zphdC1NsOmqYXpqmgvsilF6bNa1OQgAAAAAAUAAAAAAAAAAAAAAAAAAAAAACAQA4KAAAAAAAAAAAAAIA/DA==";

/// Vertices of the grid, and its triangles.
const VERTICES: usize = 13 * 9;
const TRIANGLES: usize = 12 * 8 * 2;

/// Position, normal, texture coordinates and colour of vertex x, y.
fn vertex(x: u32, y: u32) -> ([f32; 3], [f32; 3], [f32; 2], [f32; 4]) {
    let [fx, fy] = [x, y].map(|v| v as f32);
    let length = ((fx - 6.0).powi(2) + (fy - 4.0).powi(2) + 81.0).sqrt();
    let color = [20 * x, 30 * y, x * y, 255 - x].map(|v| v as f32 / 255.0);
    (
        [fx * 0.25, fy * 0.5, ((x * x + 3 * y) % 7) as f32 / 8.0],
        [(fx - 6.0) / length, (fy - 4.0) / length, 9.0 / length],
        [fx / 12.0, 1.0 - fy / 8.0],
        color,
    )
}

fn document(stream: &[u8]) -> Value {
    let float = |kind: &str| json!({"componentType": 5126, "type": kind, "count": VERTICES});
    json!({
        "extensionsUsed": ["KHR_draco_mesh_compression"], "extensionsRequired": ["KHR_draco_mesh_compression"],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{
            "attributes": {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2, "COLOR_0": 3}, "indices": 4,
            "extensions": {"KHR_draco_mesh_compression": {
                "bufferView": 0, "attributes": {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2, "COLOR_0": 3}}}}]}],
        "accessors": [float("VEC3"), float("VEC3"), float("VEC2"),
            {"componentType": 5121, "normalized": true, "type": "VEC4", "count": VERTICES},
            {"componentType": 5123, "type": "SCALAR", "count": 3 * TRIANGLES}],
        "bufferViews": [{"buffer": 0, "byteLength": stream.len()}],
    })
}

fn bytes(stream: &str) -> Vec<u8> {
    STANDARD.decode(stream).expect("base64")
}

fn mesh(imported: &Imported) -> &Mesh {
    &imported.desc.meshes[0]
}

/// Whether vertex `i` of a mesh is this one, but for the rounding of its packing.
fn is_at(mesh: &Mesh, i: usize, (p, n, [u, v], c): ([f32; 3], [f32; 3], [f32; 2], [f32; 4])) -> bool {
    let near = |a: &[f32], b: &[f32], most: f32| a.iter().zip(b).all(|(a, b)| (a - b).abs() <= most);
    near(&mesh.positions[i].to_array(), &p, 4.0 / 16383.0)
        && near(&mesh.normals[i].to_array(), &n, 4e-3)
        && near(&[mesh.uvs[i].x, mesh.uvs[i].y], &[u, 1.0 - v], 1.0 / 4095.0)
        && near(&mesh.colors[i], &c, 1e-6)
}

#[test]
fn vertices_and_triangles_are_those_that_were_packed() {
    for stream in [EDGES, SEQUENCE] {
        let stream = bytes(stream);
        let imported = import_well(document(&stream), &stream);
        assert!(
            imported.diagnostics.iter().all(|d| d.severity == Severity::Note),
            "{:?}",
            imported.diagnostics
        );
        let mesh = mesh(&imported);
        assert_eq!((mesh.positions.len(), mesh.indices.len()), (VERTICES, TRIANGLES));
        // Vertices may come in another order: each triangle of the grid is looked for by its corners.
        let number = |x: u32, y: u32| {
            let found = (0..VERTICES).find(|&i| is_at(mesh, i, vertex(x, y)));
            found.unwrap_or_else(|| panic!("no vertex {x} {y}")) as u32
        };
        let turned = |t: [u32; 3]| [[t[0], t[1], t[2]], [t[1], t[2], t[0]], [t[2], t[0], t[1]]];
        for (x, y) in (0..8).flat_map(|y| (0..12).map(move |x| (x, y))) {
            let [a, b, c, d] = [(x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1)].map(|(x, y)| number(x, y));
            for triangle in [[a, b, c], [c, b, d]] {
                assert!(turned(triangle).iter().any(|t| mesh.indices.contains(t)), "{x} {y} {triangle:?}");
            }
        }
    }
}

#[test]
fn strips_have_the_triangles_that_were_packed() {
    let stream = bytes(EDGES);
    let listed = import_well(document(&stream), &stream);
    let strip = |indices: usize| {
        let mut document = document(&stream);
        document["meshes"][0]["primitives"][0]["mode"] = json!(5);
        document["accessors"][4]["count"] = json!(indices);
        document
    };
    // One corner for each triangle after the first, or some more that join parts.
    for indices in [TRIANGLES + 2, 2 * TRIANGLES] {
        let imported = import_well(strip(indices), &stream);
        assert_eq!(mesh(&imported).indices, mesh(&listed).indices);
    }
    let (_, message) = first(&import(strip(TRIANGLES + 1), &stream), Severity::Error);
    assert!(message.contains("holds more than its accessors announce"), "{message}");
    let mut fan = strip(TRIANGLES + 2);
    fan["meshes"][0]["primitives"][0]["mode"] = json!(6);
    let (_, message) = first(&import(fan, &stream), Severity::Error);
    assert!(message.contains("a strip (5)"), "{message}");
}

#[test]
fn whole_numbers_are_unpacked_exactly() {
    let stream = bytes(EDGES);
    let mut document = document(&stream);
    let primitive = &mut document["meshes"][0]["primitives"][0];
    // The joints, of 16 bits, read as positions.
    primitive["attributes"] = json!({"POSITION": 0});
    primitive["extensions"]["KHR_draco_mesh_compression"]["attributes"] = json!({"POSITION": 4});
    document["accessors"][0] = json!({"componentType": 5123, "type": "VEC4", "count": VERTICES});
    let (_, message) = first(&import(document.clone(), &stream), Severity::Error);
    assert_eq!(message, "expected 3 numbers per element, found 4");
    // Four bytes of colour, read as four of anything.
    let primitive = &mut document["meshes"][0]["primitives"][0];
    primitive["attributes"] = json!({"POSITION": 0, "COLOR_0": 3});
    primitive["extensions"]["KHR_draco_mesh_compression"]["attributes"] =
        json!({"POSITION": 0, "COLOR_0": 4});
    document["accessors"][0] = json!({"componentType": 5126, "type": "VEC3", "count": VERTICES});
    document["accessors"][3] =
        json!({"componentType": 5123, "normalized": true, "type": "VEC4", "count": VERTICES});
    let imported = import_well(document, &stream);
    let mut joints: Vec<[u32; 4]> =
        mesh(&imported).colors.iter().map(|c| c.map(|v| (v * 65535.0).round() as u32)).collect();
    joints.sort_unstable();
    let mut expected: Vec<[u32; 4]> = (0..13).flat_map(|x| (0..9).map(move |y| [x, y, x + y, 0])).collect();
    expected.sort_unstable();
    assert_eq!(joints, expected);
}

#[test]
fn accessors_that_announce_something_else_are_told_so() {
    let stream = bytes(EDGES);
    let said = |change: &dyn Fn(&mut Value)| {
        let mut document = document(&stream);
        change(&mut document);
        first(&import(document, &stream), Severity::Error)
    };
    let (at, message) = said(&|d| d["accessors"][0]["count"] = json!(100));
    assert_eq!(at, "/accessors/0");
    assert_eq!(
        message,
        "announces 100 elements of 3 numbers, but its Draco stream holds 117 elements of 3 numbers"
    );
    let (at, message) = said(&|d| d["accessors"][4]["count"] = json!(579));
    assert_eq!(at, "/accessors/4");
    assert!(message.contains("579 elements of 1 number, but its Draco stream holds 576"), "{message}");
    let (at, message) = said(&|d| d["accessors"][4]["count"] = json!(3));
    assert_eq!(at, "/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression");
    assert_eq!(message, "the Draco stream holds more than its accessors announce");
    let (_, message) = said(&|d| d["accessors"][4]["count"] = json!(1u64 << 40));
    assert!(message.contains("announce far more than 1354 bytes can be unpacked to"), "{message}");
    let attributes = "/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression/attributes/POSITION";
    let (_, message) = said(&|d| *d.pointer_mut(attributes).expect("written") = json!(77));
    assert_eq!(message, "the Draco stream has no attribute 77");
}

#[test]
fn damaged_streams_are_told_from_sound_ones_without_a_panic() {
    let sound = bytes(EDGES);
    let (mut refused, mut read) = (0, 0);
    for place in 0..sound.len() {
        let mut stream = sound.clone();
        stream[place] ^= 1 << (place % 8);
        let imported = import(document(&sound), &stream);
        match imported.diagnostics.has_errors() {
            true => refused += 1,
            false => read += 1,
        }
        if place % 16 == 0 {
            let imported = import(document(&sound[..place]), &sound[..place]);
            let (_, message) = first(&imported, Severity::Error);
            assert!(message.contains("the Draco stream"), "{place}: {message}");
        }
    }
    // Most bits are those of values.
    assert!(refused > 50 && read > 500, "{refused} refused, {read} read");
}
