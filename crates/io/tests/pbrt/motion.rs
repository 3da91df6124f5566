//! Moving things: two matrices as in pbrt, and our keys, against positions in closed form.
use std::f64::consts::TAU;

use durer_core::{glam::DVec3, math::Motion};

use super::{
    read::{complaints, read, sound},
    scene::is,
};

#[test]
fn moving_things_get_two_keys() {
    let desc = sound(
        "TransformTimes 1 3 WorldBegin AttributeBegin ActiveTransform EndTime Translate 2 0 0 ActiveTransform All\n\
         Scale 2 2 2 Shape \"a\" AttributeEnd Shape \"b\"\n\
         ObjectBegin \"o\" Shape \"c\" ObjectEnd ActiveTransform StartTime Translate 0 4 0 ObjectInstance \"o\"",
    );
    let [a, b, c] = [0, 1, 2].map(|i: usize| &desc.shapes[i].world_from_object);
    assert_eq!(a.keys().iter().map(|k| k.0).collect::<Vec<_>>(), [1.0, 3.0]);
    is(a.at(1.0), [[2., 0., 0.], [0., 2., 0.], [0., 0., 2.], [0., 0., 0.]]);
    is(a.at(3.0), [[2., 0., 0.], [0., 2., 0.], [0., 0., 2.], [2., 0., 0.]]);
    assert_eq!(b.keys().len(), 1);
    assert_eq!((c.at(1.0).translation, c.at(3.0).translation), (DVec3::new(0., 4., 0.), DVec3::ZERO));
}

/// The motion of the only shape of `body`.
fn motion(body: &str) -> Motion {
    let desc = sound(&format!("TransformTimes 0 2 WorldBegin\n{body}\nShape \"sphere\""));
    desc.shapes[0].world_from_object.clone()
}

fn origin(motion: &Motion, time: f64) -> DVec3 {
    motion.at(time).translation
}

fn near(a: DVec3, b: DVec3, within: f64) {
    assert!((a - b).length() < within, "{a} is not {b}");
}

#[test]
fn keys_translate_rotate_and_scale() {
    let m = motion(
        "TransformKeys \"float times\" [0 1 4] \"point3 translate\" [1 0 0  3 0 0  3 6 0]\n\
         \"float rotate\" [0 0 0 1  90 0 0 1  90 0 0 1] \"vector3 scale\" [1 1 1  1 1 1  3 1 1]",
    );
    for (time, expected) in
        [(-1.0, [1.0, 0.0, 0.0]), (0.5, [2.0, 0.0, 0.0]), (2.5, [3.0, 3.0, 0.0]), (9.0, [3.0, 6.0, 0.0])]
    {
        near(origin(&m, time), DVec3::from(expected), 1e-12);
    }
    // Translation times rotation times scale: x is stretched, then turned to y.
    is(m.at(4.0), [[0., 3., 0.], [-1., 0., 0.], [0., 0., 1.], [3., 6., 0.]]);
    near(m.at(2.5).transform_vector3(DVec3::X), DVec3::new(0.0, 2.0, 0.0), 1e-12);
    near(m.at(0.5).transform_vector3(DVec3::X), DVec3::new(0.5f64.sqrt(), 0.5f64.sqrt(), 0.0), 1e-12);
}

#[test]
fn keys_may_be_matrices() {
    let m = motion(
        "TransformKeys \"float times\" [0 2] \"float matrices\" [1 0 0  0 1 0  0 0 1  1 0 0   0 2 0  -2 0 0  0 0 2  3 4 0]",
    );
    is(m.at(2.0), [[0., 2., 0.], [-2., 0., 0.], [0., 0., 2.], [3., 4., 0.]]);
    // A quarter turn and twice as large: half of each.
    let r = 1.5 * 0.5f64.sqrt();
    is(m.at(1.0), [[r, r, 0.], [-r, r, 0.], [0., 0., 1.5], [2., 2., 0.]]);
}

#[test]
fn turns_are_whole_and_what_orbits_stays_on_its_circle() {
    for turns in [1.0, 2.0, -7.5] {
        let degrees = turns * 360.0;
        let m = motion(&format!(
            "TransformKeys \"float times\" [0 1] \"float rotate\" [0 0 1 0  {degrees} 0 1 0]\nTranslate 0 0 5"
        ));
        for i in 0..=1000 {
            let time = f64::from(i) / 1000.0;
            let angle = TAU * turns * time;
            near(origin(&m, time), DVec3::new(5.0 * angle.sin(), 0.0, 5.0 * angle.cos()), 5.0 * 0.00062);
            near(m.at(time).transform_vector3(DVec3::X), DVec3::new(angle.cos(), 0.0, -angle.sin()), 1e-3);
        }
    }
    // The same axis the other way round, and another axis.
    let m = motion("TransformKeys \"float times\" [0 1] \"float rotate\" [90 0 0 1  270 0 0 -2]");
    near(m.at(0.75).transform_vector3(DVec3::X), DVec3::NEG_X, 1e-12);
    let m = motion("TransformKeys \"float times\" [0 1] \"float rotate\" [90 1 0 0  90 0 1 0]");
    is(m.at(1.0), [[0., 0., -1.], [0., 1., 0.], [1., 0., 0.], [0., 0., 0.]]);
}

#[test]
fn keys_combine_with_everything_that_places() {
    // Before, behind and within: pairs move linearly between the transform times 0 and 2.
    let m = motion(
        "ActiveTransform EndTime Translate 4 0 0 ActiveTransform All\n\
         TransformKeys \"float times\" [0 1] \"float rotate\" [0 0 0 1  90 0 0 1]\n\
         TransformKeys \"float times\" [0.5 1.5] \"point3 translate\" [0 0 0  2 0 0]\nScale 2 2 2",
    );
    for time in [0.0, 0.5, 1.0, 1.5, 2.0] {
        let angle: f64 = TAU / 4.0 * f64::min(time, 1.0);
        let along = 2.0 * (time - 0.5).clamp(0.0, 1.0);
        let expected = DVec3::new(2.0 * time + along * angle.cos(), along * angle.sin(), 0.0);
        near(origin(&m, time), expected, 1e-12);
        assert!((m.at(time).transform_vector3(DVec3::Z).z - 2.0).abs() < 1e-12);
    }
    let spin = "TransformKeys \"float times\" [0 1] \"float rotate\" [0 0 0 1  360 0 0 1]";
    // Blocks bring the still placement back; coordinate systems keep the motion.
    let desc = sound(&format!(
        "WorldBegin AttributeBegin {spin} CoordinateSystem \"disc\" Shape \"a\" AttributeEnd Shape \"b\"\n\
         CoordSysTransform \"disc\" Translate 1 0 0 Shape \"c\" Identity Shape \"d\""
    ));
    let motions: Vec<_> = desc.shapes.iter().map(|s| &s.world_from_object).collect();
    assert_eq!(motions.iter().map(|m| m.is_still()).collect::<Vec<_>>(), [false, true, false, true]);
    near(origin(motions[2], 0.25), DVec3::Y, 1e-3);
    // A moving instance of a moving object has the keys of both.
    let desc = sound(&format!(
        "WorldBegin ObjectBegin \"o\" TransformKeys \"float times\" [0 0.3 1] \"point3 translate\" [0 0 0 3 0 0 3 0 0]\n\
         Shape \"a\" ObjectEnd {spin} ObjectInstance \"o\""
    ));
    let m = &desc.shapes[0].world_from_object;
    assert_eq!(m.keys().len(), 92);
    for time in [0.0, 0.3, 0.5, 1.0] {
        let (r, angle) = (f64::min(10.0 * time, 3.0), TAU * time);
        near(
            origin(m, time),
            DVec3::new(r * angle.cos(), r * angle.sin(), 0.0),
            1e-12 + 0.01 * f64::from(time == 0.3),
        );
    }
}

#[test]
fn keys_are_checked() {
    let says = |keys: &str| {
        let found = complaints(&read(&format!("WorldBegin\nTransformKeys {keys}\nShape \"sphere\"")));
        assert_eq!(found.len(), 1, "{found:?}");
        found[0].clone()
    };
    assert!(says("").contains("2:1 error: TransformKeys needs the parameter \"float times\""));
    assert!(says("\"float times\" [1 1]").contains("each later than the one before"));
    assert!(says("\"float times\" []").contains("one moment or more"));
    let two = "\"float times\" [0 1]";
    assert!(
        says(&format!("{two} \"point3 translate\" [0 0 0]"))
            .contains("three numbers for each of the 2 times")
    );
    assert!(
        says(&format!("{two} \"float rotate\" [0 0 0 1 90 0 0]")).contains("four numbers for each of the 2")
    );
    assert!(says(&format!("{two} \"float rotate\" [0 0 0 1 90 0 0 0]")).contains("must not be 0 0 0"));
    assert!(says(&format!("{two} \"vector3 scale\" [1 1 1 1 0 1]")).contains("singular"));
    assert!(says(&format!("{two} \"float rotate\" [0 0 0 1 1e9 0 0 1]")).contains("turns too far"));
    assert!(says(&format!("{two} \"float rotat\" [1]")).contains("did you mean \"rotate\"?"));
    let one = "1 0 0  0 1 0  0 0 1  0 0 0";
    assert!(says(&format!("{two} \"float matrices\" [{one}]")).contains("twelve numbers for each of the 2"));
    assert!(says(&format!("{two} \"float matrices\" [{one} 1 0 0 0 1 0 0 0 0 0 0 0]")).contains("singular"));
    let both = format!("{two} \"float matrices\" [{one} {one}] \"vector3 scale\" [1 1 1 2 2 2]");
    assert!(says(&both).contains("leave \"scale\" out"));
    let twice = format!("\"float times\" [2 2] \"float matrices\" [{one} {one}]");
    assert!(says(&twice).contains("key times must rise"));
    let nested = format!("{two} ").repeat(1) + &format!("TransformKeys {two} ").repeat(4);
    assert!(says(&nested).contains("more than 4 deep"));
    let found = complaints(&read(&format!("WorldBegin ActiveTransform EndTime TransformKeys {two}")));
    assert!(found[0].contains("needs ActiveTransform All"), "{found:?}");
}

#[test]
fn a_factor_that_goes_through_zero_is_told_where_it_stands() {
    let text = "WorldBegin\nTransformKeys \"float times\" [0 1]\n \"vector3 scale\" [1 1 1 -1 1 1]\nShape \"sphere\"";
    let all = complaints(&read(text));
    assert_eq!(all.len(), 1, "{all:?}");
    assert!(all[0].starts_with("3:2 error: a factor changes its sign"), "{all:?}");
}
