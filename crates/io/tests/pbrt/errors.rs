//! Bad texts: what is said, and the exact text it points at.
use super::read::{complaints, read};

/// The complaints about `text` are these.
fn says(text: &str, expected: &[&str]) {
    assert_eq!(complaints(&read(text)), expected, "in {text:?}");
}

/// The complaints about `body` after WorldBegin (line 2) are these.
fn world_says(body: &str, expected: &[&str]) {
    says(&format!("WorldBegin\n{body}"), expected);
}

#[test]
fn several_errors_are_found_in_one_run() {
    world_says(
        "Shpae \"sphere\" \"float radius\" 1\n\
         Shape \"sphere\" \"flaot radius\" 1\n\
         Translate 1 x 3\n\
         Shape \"sphere\" \"float radius\" [ 1 2 oops 4 ] \"float zmin\" \"low\"\n\
         NamedMaterial \"glas\"\n\
         MakeNamedMaterial \"glass\" \"string type\" \"dielectric\"\n",
        &[
            "2:1 error: unknown directive \"Shpae\" | Shpae | did you mean \"Shape\"?",
            "3:17 error: unknown parameter type \"flaot\" | flaot | did you mean \"float\"?",
            "4:13 error: expected a number, found x | x",
            "5:37 error: expected a number for \"float radius\", found oops | oops",
            "5:59 error: expected a number for \"float zmin\", found the string \"low\" | \"low\"",
            "6:15 error: unknown material \"glas\" | \"glas\" | did you mean \"glass\"?",
        ],
    );
}

#[test]
fn strings_and_brackets_must_be_closed() {
    world_says(
        "Shape \"sphere\nShape \"sphere\" \"string name\" \"a\nShape \"disk\"",
        &[
            "2:7 error: this string is not closed | \"sphere | a closing quote is missing: strings end on the line they begin on",
            "3:30 error: this string is not closed | \"a | a closing quote is missing: strings end on the line they begin on",
        ],
    );
    world_says("Shape \"sphere\" \"float radius\" [ 1", &["2:31 error: this [ is not closed | ["]);
    world_says(
        "Shape \"trianglemesh\" \"point3 P\" [ 1 2 3 \"float x\" 1\nShape \"disk\"",
        &["2:33 error: this [ is not closed | ["],
    );
    world_says(
        "Shape \"polygon\" \"point3 P\" [ 1 2 3\nShape \"disk\"",
        &["2:28 error: this [ is not closed | ["],
    );
    world_says(
        "Transform [1 0 0 0",
        &["2:1 error: Transform needs 16 numbers, 4 are given | Transform [1 0 0 0"],
    );
    world_says(
        "Transform [1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\nIdentity",
        &["2:11 error: this [ is not closed | ["],
    );
    world_says(
        "Transform [1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 5]",
        &["2:44 error: expected ] after 16 numbers, found 5 | 5"],
    );
    world_says("Transform 1 2", &["2:1 error: Transform needs 16 numbers in [ ] | Transform"]);
}

#[test]
fn escapes_are_checked() {
    world_says(
        "Shape \"plymesh\" \"string filename\" \"tex\\qood\"",
        &[
            "2:39 error: unknown escape in a string | \\q | known are \\b \\f \\n \\r \\t \\\\ \\' \\\"; write paths with / instead of \\",
        ],
    );
}

#[test]
fn directives_need_their_arguments() {
    world_says(
        "Translate 1 2\nShape\nRotate 90 0 0 z\nScale [1 1 1]\nTranslate 1 2 3 4",
        &[
            "2:1 error: Translate needs 3 numbers, 2 are given | Translate 1 2",
            "3:1 error: Shape needs a kind of shape in quotes | Shape",
            "4:15 error: expected a number, found z | z",
            "5:7 error: expected a number, found [ | [",
            "6:17 error: expected a directive such as Shape, found 4 | 4",
        ],
    );
    world_says("Shape sphere", &["2:7 error: expected a kind of shape in quotes, found sphere | sphere"]);
    world_says("LookAt 0 0 0 1", &["2:1 error: LookAt needs 9 numbers, 4 are given | LookAt 0 0 0 1"]);
    world_says(
        "ActiveTransform Startime",
        &["2:17 error: unknown time \"Startime\" | Startime | did you mean \"StartTime\"?"],
    );
    says(
        "TransformTimes 1 1\nOption\nWorldBegin",
        &[
            "1:1 error: the second of the TransformTimes must be later than the first: 1, 1 | TransformTimes",
            "2:1 error: Option needs one parameter such as \"integer seed\" 1 | Option",
        ],
    );
}

#[test]
fn values_must_fit_their_type() {
    world_says(
        "Shape \"s\" \"integer n\" 1.0 \"integer m\" [ 1 3000000000 ] \"bool b\" maybe \"bool c\" \"true\"\n\
         \"float x\" 1e39 \"string s\" 5 \"texture t\" 0.5 \"rgb c2\" [ 1 2 ] \"point3 p\" 1 \"spectrum q\" [ 400 1 500 ]",
        &[
            "2:23 error: expected an integer for \"integer n\", found 1.0 | 1.0 | integers are written without point and exponent",
            "2:43 error: 3000000000 is too large for an integer for \"integer m\" | 3000000000",
            "2:65 error: expected true or false for \"bool b\", found maybe | maybe",
            "3:11 error: 1e39 is too large for a number for \"float x\" | 1e39",
            "3:27 error: expected a string for \"string s\", found 5 | 5",
            "3:41 error: expected the name of a texture in quotes for \"texture t\", found 0.5 | 0.5",
            "3:45 error: \"c2\" has 2 numbers, \"rgb\" needs 3 per value | \"rgb c2\" [ 1 2 ]",
            "3:62 error: \"p\" has 1 numbers, \"point3\" needs 3 per value | \"point3 p\" 1",
            "3:75 error: \"q\" has 3 numbers, \"spectrum\" needs 2 per value | \"spectrum q\" [ 400 1 500 ]",
        ],
    );
}

#[test]
fn parameter_lists_are_checked() {
    world_says(
        "Shape \"s\" \"float radius\" 1 \"float radius\" [ 2 ]",
        &["2:28 error: the parameter \"radius\" is given twice | \"float radius\" [ 2 ]"],
    );
    world_says(
        "Shape \"s\" \"float radius\" \"float height\" 2\nShape \"s\" \"float x\"\nShape \"t\" \"float y\"",
        &[
            "2:11 error: \"radius\" has no value | \"float radius\"",
            "3:11 error: \"x\" has no value | \"float x\"",
            "4:11 error: \"y\" has no value | \"float y\"",
        ],
    );
    world_says(
        "Shape \"s\" \"float x\" 1 2\nShape \"s\" \"radius\" 1\nShape \"s\" \"color Kd\" [ 1 1 1 ]",
        &[
            "2:23 error: one value too many: 2 | 2 | several values are written in [ ]",
            "3:11 error: expected a parameter such as \"float radius\", found the string \"radius\" | \"radius\"",
            "4:12 error: unknown parameter type \"color\" | color | pbrt-v4 writes \"rgb\"",
        ],
    );
    world_says(
        "Shape \"s\" \"float name\" 1",
        &["2:11 error: \"name\" must be one string | \"float name\" 1"],
    );
    let many: String = (0..300).map(|i| format!(" \"float x{i}\" 1")).collect();
    let found = complaints(&read(&format!("WorldBegin Shape \"s\"{many}")));
    assert_eq!(found, ["1:3752 error: more than 256 parameters | \"float x256\""]);
}

#[test]
fn order_matters() {
    says(
        "Shape \"sphere\"\nMaterial \"diffuse\"\nWorldBegin\nCamera \"perspective\"\nWorldBegin",
        &[
            "1:1 error: Shape must stand after WorldBegin | Shape",
            "4:1 error: Camera must stand before WorldBegin | Camera",
            "5:1 error: a second WorldBegin | WorldBegin",
        ],
    );
    says("Identity # nothing else\n", &["2:1 error: the scene has no WorldBegin | "]);
    says("", &["1:1 error: the scene has no WorldBegin | "]);
}

#[test]
fn blocks_must_balance() {
    world_says(
        "AttributeBegin\nAttributeEnd\nAttributeEnd\nObjectEnd\nAttributeBegin",
        &[
            "4:1 error: AttributeEnd without AttributeBegin | AttributeEnd",
            "5:1 error: ObjectEnd without ObjectBegin | ObjectEnd",
            "6:1 error: AttributeBegin is not closed by AttributeEnd | AttributeBegin",
        ],
    );
    world_says(
        "ObjectBegin \"o\"\nAttributeBegin\nObjectEnd\nObjectInstance \"o\"",
        &["3:1 error: AttributeBegin is not closed by AttributeEnd | AttributeBegin"],
    );
    world_says(
        "TransformBegin TransformEnd TransformBegin TransformEnd",
        &["2:1 warning: TransformBegin is deprecated: pbrt-v4 has AttributeBegin only | TransformBegin"],
    );
    let deep = "AttributeBegin ".repeat(300) + &"AttributeEnd ".repeat(300);
    assert_eq!(
        complaints(&read(&format!("WorldBegin\n{deep}"))),
        ["2:3841 error: blocks are nested more than 256 deep | AttributeBegin"]
    );
}

#[test]
fn transformations_must_have_an_inverse() {
    world_says(
        "Scale 1 0 1\nRotate 9 0 0 0\nLookAt 1 1 1 1 1 1 0 1 0\n\
         Transform [1 0 0 0.5 0 1 0 0 0 0 1 0 0 0 0 1]\nCoordSysTransform \"wrold\"",
        &[
            "2:1 error: this makes the current transformation singular: it has no inverse, so shapes would be flat | Scale",
            "3:1 error: the axis of a rotation must not be 0 0 0 | Rotate",
            "4:1 error: LookAt: the eye and the point looked at are the same | LookAt",
            "5:1 error: the 4th, 8th and 12th number must be 0 and the 16th 1: durer has no projective transformations | Transform",
            "6:19 error: unknown coordinate system \"wrold\" | \"wrold\" | did you mean \"world\"?",
        ],
    );
}

#[test]
fn names_are_defined_once_and_before_the_end() {
    world_says(
        "MakeNamedMaterial \"m\" \"string type\" \"diffuse\"\nMakeNamedMaterial \"m\" \"string type\" \"mirror\"\n\
         MakeNamedMaterial \"n\"\nNamedMaterial \"n\"\n\
         Texture \"t\" \"float\" \"constant\"\nTexture \"t\" \"spectrum\" \"constant\"\nTexture \"t\" \"float\" \"constant\"\n\
         Texture \"u\" \"flout\" \"constant\"\nObjectInstance \"tre\"\nObjectBegin \"tree\"\nObjectEnd\n\
         ObjectBegin \"tree\"\nObjectInstance \"tree\"\nObjectEnd",
        &[
            "3:19 error: the material \"m\" is defined twice | \"m\"",
            "4:19 error: MakeNamedMaterial needs the parameter \"string type\" | \"n\"",
            "8:9 error: the float texture \"t\" is defined twice | \"t\"",
            "9:13 error: unknown texture type \"flout\" | \"flout\" | did you mean \"float\"?",
            "13:13 error: the object \"tree\" is defined twice | \"tree\"",
            "14:16 error: an object cannot contain instances | \"tree\"",
            "10:16 error: unknown object \"tre\" | \"tre\" | did you mean \"tree\"?",
            "- note: 1 object definition(s) are never placed by ObjectInstance | ",
        ],
    );
}

#[test]
fn film_and_sampler_are_checked() {
    says(
        "Film \"rgb\" \"integer xresolutoin\" 5 \"float yresolution\" 3 \"float iso\" 200\n\
         Sampler \"sobl\" \"integer pixelsamples\" 0\nFilm \"image\"\nColorSpace \"rec709\"\nOption \"integer sed\" 1\nWorldBegin",
        &[
            "1:12 error: unknown parameter of rgb \"xresolutoin\" | \"integer xresolutoin\" 5 | did you mean \"xresolution\"?",
            "1:36 error: \"yresolution\" is declared float, expected integer | \"float yresolution\" 3",
            "2:9 error: unknown sampler \"sobl\" | \"sobl\" | did you mean \"sobol\"?",
            "2:16 error: \"pixelsamples\" is 0, expected 1 to 1000000000 | \"integer pixelsamples\" 0",
            "3:1 warning: this Film replaces the earlier one | Film",
            "3:6 error: unknown film \"image\" | \"image\" | this is pbrt-v3's word; pbrt-v4 writes \"rgb\"",
            "4:12 error: unknown colour space \"rec709\" | \"rec709\" | did you mean \"rec2020\"?",
            "5:8 error: unknown option \"sed\" | \"integer sed\" 1 | did you mean \"seed\"?",
        ],
    );
}

#[test]
fn colours_that_rec_709_does_not_hold_are_cut_off_and_named_once() {
    world_says(
        "ColorSpace \"rec2020\"\nMaterial \"diffuse\" \"rgb reflectance\" [.5 .4 .5]\n\
         Material \"diffuse\" \"rgb reflectance\" [0 1 0]\nMaterial \"diffuse\" \"rgb reflectance\" [0 .9 0]\nShape \"sphere\"",
        &[
            "4:20 warning: a colour of rec2020 lies outside Rec. 709: it is cut off | \"rgb reflectance\" [0 1 0]",
        ],
    );
}

#[test]
fn parts_of_the_picture_that_hold_no_pixel_are_refused() {
    let film = |words: &str, complaint: &str| {
        says(
            &format!("Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 6 {words}\nWorldBegin"),
            &[complaint],
        );
    };
    film(
        "\"float cropwindow\" [.5 .5 0 1]",
        "1:60 error: no pixel of the picture lies in x 4 to 4 and y 0 to 6 | \"float cropwindow\" [.5 .5 0 1]",
    );
    film(
        "\"integer pixelbounds\" [8 9 0 6]",
        "1:60 error: no pixel of the picture lies in x 8 to 9 and y 0 to 6 | \"integer pixelbounds\" [8 9 0 6]",
    );
    film(
        "\"integer pixelbounds\" [0 1 2]",
        "1:60 error: \"pixelbounds\" has 3 values, expected 4: x0 x1 y0 y1 | \"integer pixelbounds\" [0 1 2]",
    );
    film(
        "\"float cropwindow\" [0 1 0 2]",
        "1:60 error: \"cropwindow\" is 2, expected 0 to 1 | \"float cropwindow\" [0 1 0 2]",
    );
}

#[test]
fn what_is_not_supported_warns_once() {
    says(
        "Film \"gbuffer\" \"float iso\" 200 \"float diagonal\" 20\nAccelerator \"kdtree\"\nOption \"bool pixelstats\" true\nOption \"bool pixelstats\" true\n\
         ColorSpace \"rec2020\"\n\
         MakeNamedMedium \"fog\" \"string type\" \"homogeneous\"\nWorldBegin\nMediumInterface \"\" \"\"\nMediumInterface \"fog\"\n\
         AreaLightSource \"diffuse\" \"rgb L\" [1 1 1]\nShape \"sphere\"\nAreaLightSource \"diffuse\"\nWorldEnd",
        &[
            "2:13 note: durer chooses its acceleration structure itself | \"kdtree\"",
            "3:8 warning: \"pixelstats\" writes no files | \"bool pixelstats\" true | \"durer view\" shows the rays and the noise of each pixel, the integrator \"cast\" with \"cost\" what its first hit takes",
            "13:1 warning: pbrt-v4 has no WorldEnd: it is ignored | WorldEnd",
        ],
    );
}

#[test]
fn too_many_errors_end_the_run() {
    let found = complaints(&read(&"Oops ] ".repeat(1000)));
    assert!(found.len() <= 52, "{}", found.len());
    assert_eq!(
        found.last().map(String::as_str),
        Some("- note: too many errors: the rest of the scene is not checked | ")
    );
    let params = "\"flot x\" 1 ".repeat(1000);
    let found = complaints(&read(&format!("WorldBegin Shape \"s\" {params}")));
    assert!(found.len() <= 52, "{}", found.len());
}

#[test]
fn columns_count_characters() {
    world_says(
        "# größe\nShape \"küché\" wörd",
        &[
            "3:15 error: unknown directive \"wörd\" | wörd | valid: AttributeBegin, AttributeEnd, Transform, ObjectInstance, Shape, NamedMaterial, Material, Translate, Scale, Rotate, ConcatTransform, ObjectBegin and 31 more",
        ],
    );
}

#[test]
fn a_misspelt_world_begin_has_no_consequences() {
    let found = complaints(&read("WorldBegn\nLightSource \"distant\"\nShape \"sphere\""));
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(found[0].contains("unknown directive \"WorldBegn\""), "{found:?}");
}
