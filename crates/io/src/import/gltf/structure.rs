//! The shape of a whole document, used or not: types of JSON values, and references that lead somewhere (glTF 2.0,
//! section 5). What values mean is checked where they are used.
use super::{
    document::{Document, only},
    element::{Checked, Element},
};

/// What a JSON value must be.
enum Is {
    Text,
    Number,
    Whole,
    Flag,
    Numbers,
    /// An index into a list of the document.
    Ref(&'static str),
    /// Indices into a list of the document.
    Refs(&'static str),
    /// An object with these members, all of which may be missing.
    Part(&'static [(&'static str, Is)]),
    /// An array of such objects.
    Parts(&'static [(&'static str, Is)]),
    /// An object all of whose members are such.
    Each(&'static Is),
    /// An array of such.
    List(&'static Is),
}

use Is::{Each, Flag, List, Number, Numbers, Part, Parts, Ref, Refs, Text, Whole};

const TEXTURE: &[(&str, Is)] =
    &[("index", Ref("textures")), ("texCoord", Whole), ("scale", Number), ("strength", Number), EXTENSIONS];
const EXTENSIONS: (&str, Is) = ("extensions", Each(&Part(&[])));
const ATTRIBUTES: Is = Each(&Ref("accessors"));
const SAMPLER: &[(&str, Is)] =
    &[("magFilter", Whole), ("minFilter", Whole), ("wrapS", Whole), ("wrapT", Whole), EXTENSIONS];

const ROOT: &[(&str, Is)] = &[
    ("accessors", Parts(ACCESSOR)),
    ("animations", Parts(ANIMATION)),
    ("asset", Part(&[("version", Text), ("minVersion", Text), EXTENSIONS])),
    ("buffers", Parts(&[("uri", Text), ("byteLength", Whole), EXTENSIONS])),
    ("bufferViews", Parts(VIEW)),
    ("cameras", Parts(CAMERA)),
    EXTENSIONS,
    ("extensionsRequired", List(&Text)),
    ("extensionsUsed", List(&Text)),
    ("images", Parts(&[("uri", Text), ("mimeType", Text), ("bufferView", Ref("bufferViews")), EXTENSIONS])),
    ("materials", Parts(MATERIAL)),
    ("meshes", Parts(&[("primitives", Parts(PRIMITIVE)), ("weights", Numbers), EXTENSIONS])),
    ("nodes", Parts(NODE)),
    ("samplers", Parts(SAMPLER)),
    ("scene", Ref("scenes")),
    ("scenes", Parts(&[("nodes", Refs("nodes")), EXTENSIONS])),
    ("skins", Parts(SKIN)),
    ("textures", Parts(&[("sampler", Ref("samplers")), ("source", Ref("images")), EXTENSIONS])),
];
const SKIN: &[(&str, Is)] = &[
    ("inverseBindMatrices", Ref("accessors")),
    ("joints", Refs("nodes")),
    ("skeleton", Ref("nodes")),
    EXTENSIONS,
];
const ACCESSOR: &[(&str, Is)] = &[
    ("bufferView", Ref("bufferViews")),
    ("byteOffset", Whole),
    ("componentType", Whole),
    ("count", Whole),
    ("max", Numbers),
    ("min", Numbers),
    ("normalized", Flag),
    ("type", Text),
    ("sparse", Part(SPARSE)),
    EXTENSIONS,
];
const SPARSE: &[(&str, Is)] = &[
    ("count", Whole),
    ("indices", Part(&[("bufferView", Ref("bufferViews")), ("byteOffset", Whole), ("componentType", Whole)])),
    ("values", Part(&[("bufferView", Ref("bufferViews")), ("byteOffset", Whole)])),
];
const ANIMATION: &[(&str, Is)] = &[
    (
        "channels",
        Parts(&[("sampler", Whole), ("target", Part(&[("node", Ref("nodes")), ("path", Text), EXTENSIONS]))]),
    ),
    (
        "samplers",
        Parts(&[("input", Ref("accessors")), ("output", Ref("accessors")), ("interpolation", Text)]),
    ),
    EXTENSIONS,
];
const VIEW: &[(&str, Is)] = &[
    ("buffer", Ref("buffers")),
    ("byteOffset", Whole),
    ("byteLength", Whole),
    ("byteStride", Whole),
    ("target", Whole),
    EXTENSIONS,
];
const CAMERA: &[(&str, Is)] = &[
    ("type", Text),
    ("orthographic", Part(&[("xmag", Number), ("ymag", Number), ("zfar", Number), ("znear", Number)])),
    ("perspective", Part(&[("aspectRatio", Number), ("yfov", Number), ("zfar", Number), ("znear", Number)])),
    EXTENSIONS,
];
const MATERIAL: &[(&str, Is)] = &[
    ("alphaCutoff", Number),
    ("alphaMode", Text),
    ("doubleSided", Flag),
    ("emissiveFactor", Numbers),
    ("emissiveTexture", Part(TEXTURE)),
    ("normalTexture", Part(TEXTURE)),
    ("occlusionTexture", Part(TEXTURE)),
    (
        "pbrMetallicRoughness",
        Part(&[
            ("baseColorFactor", Numbers),
            ("baseColorTexture", Part(TEXTURE)),
            ("metallicFactor", Number),
            ("metallicRoughnessTexture", Part(TEXTURE)),
            ("roughnessFactor", Number),
            EXTENSIONS,
        ]),
    ),
    EXTENSIONS,
];
const PRIMITIVE: &[(&str, Is)] = &[
    ("attributes", ATTRIBUTES),
    ("indices", Ref("accessors")),
    ("material", Ref("materials")),
    ("mode", Whole),
    ("targets", List(&ATTRIBUTES)),
    EXTENSIONS,
];
const NODE: &[(&str, Is)] = &[
    ("camera", Ref("cameras")),
    ("children", Refs("nodes")),
    ("matrix", Numbers),
    ("mesh", Ref("meshes")),
    ("rotation", Numbers),
    ("scale", Numbers),
    ("skin", Ref("skins")),
    ("translation", Numbers),
    ("weights", Numbers),
    EXTENSIONS,
];

/// Checks the whole document; complains about every place that is wrong.
///
/// # Errors
/// If the outermost value is no object.
pub(super) fn check(document: &Document<'_>) -> Checked<()> {
    part(document, &document.root, ROOT)?;
    for material in document.root.list("materials").unwrap_or_default() {
        document.keep(textures_of_extensions(document, &material));
    }
    document.keep(variants(document));
    Ok(())
}

fn part<'a>(document: &Document<'a>, object: &Element<'a>, members: &[(&str, Is)]) -> Checked<()> {
    for (key, is) in members {
        if let Some(value) = object.get(key)? {
            document.keep(value_is(document, &value, is));
        }
    }
    if let Some(name) = object.get("name")?
        && let Err(fault) = name.text()
    {
        document.warn(&name, format!("{}; the name is ignored", fault.message));
    }
    // An object without members of interest is still to be one.
    object.get("").map(drop)
}

fn value_is<'a>(document: &Document<'a>, value: &Element<'a>, is: &Is) -> Checked<()> {
    match is {
        Text => value.text().map(drop),
        Number => value.number().map(drop),
        Whole => value.index().map(drop),
        Flag => value.truth().map(drop),
        Numbers => value.items()?.try_for_each(|v| v.number().map(drop)),
        Ref(list) => document.item(list, value).map(drop),
        Refs(list) => value.items()?.try_for_each(|v| document.item(list, &v).map(drop)),
        Part(members) => part(document, value, members),
        Parts(members) => {
            for item in value.items()? {
                document.keep(part(document, &item, members));
            }
            Ok(())
        }
        Each(is) => {
            value.get("")?;
            for key in value.keys() {
                if let Some(member) = value.get(key)? {
                    document.keep(value_is(document, &member, is));
                }
            }
            Ok(())
        }
        List(is) => {
            for item in value.items()? {
                document.keep(value_is(document, &item, is));
            }
            Ok(())
        }
    }
}

/// Extensions of materials, read or not, name textures in one way.
fn textures_of_extensions<'a>(document: &Document<'a>, material: &Element<'a>) -> Checked<()> {
    let Some(extensions) = material.get("extensions")? else {
        return Ok(());
    };
    for name in extensions.keys() {
        let Some(extension) = extensions.get(name)? else { continue };
        for key in extension.keys().filter(|key| key.ends_with("Texture")) {
            if let Some(info) = extension.get(key)? {
                part(document, &info, TEXTURE)?;
            }
        }
    }
    Ok(())
}

/// KHR_materials_variants: the default materials are drawn, but references must hold.
fn variants(document: &Document<'_>) -> Checked<()> {
    const NAME: &str = "KHR_materials_variants";
    let variants = match document.root.extension(NAME)? {
        Some(extension) => extension.list("variants")?,
        None => return Ok(()),
    };
    for variant in &variants {
        part(document, variant, &[("name", Text)])?;
    }
    for mesh in document.root.list("meshes")? {
        for primitive in mesh.list("primitives")? {
            let Some(extension) = primitive.extension(NAME)? else { continue };
            for mapping in extension.list("mappings")? {
                part(document, &mapping, &[("material", Ref("materials"))])?;
                for index in mapping.list("variants")? {
                    if index.index()? >= variants.len() {
                        let message =
                            format!("refers to a variant, but {}", only(variants.len(), "variants"));
                        return Err(index.fault(message));
                    }
                }
            }
        }
    }
    Ok(())
}
