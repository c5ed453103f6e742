//! Generators of bodies and states, the independent model, and reference motions of that model.

pub mod loss_power;
pub mod many;
pub mod rim;

use nalgebra::{Matrix3, Vector3, Vector4};
use proptest::prelude::*;
use spincyl::motion::path::Path;
use spincyl::motion::{Ask, Method, Motion, roll_with};
use spincyl::{Body, Contact, Error, State, steady};

/// How many of `count` random cases are tested: a third in `make test`, all if `SPINCYL_LONG` is set, as in `make
/// long`.
pub fn drawn(count: usize) -> usize {
    if std::env::var_os("SPINCYL_LONG").is_some() { count } else { count / 3 }
}

/// The configuration of a proptest with this number of cases. Failures are not stored, since a case that failed is
/// made a test.
pub fn cases(count: usize) -> ProptestConfig {
    let count = drawn(count).max(64.min(count)) as u32;
    ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(count) }
}

/// Random tubes from disks to pipes, among them the critical shape and shapes close to it.
pub fn ordinary_tube() -> impl Strategy<Value = Body> {
    let ell =
        prop_oneof![0.0..3.0f64, 0.0..1.0f64, 3.0..30.0f64, Just(0.75f64.sqrt()), Just(0.25), Just(0.8)];
    let bore = prop_oneof![Just(0.0), 0.0..1.0f64, Just(1.0)];
    (ell, bore).prop_map(|(ell, bore)| Body::tube(ell, bore).unwrap())
}

/// Random bodies with sharp rims: tubes, and bodies like bottles and cans with any moments of inertia, some of them
/// equal.
pub fn any_body() -> impl Strategy<Value = Body> {
    let general = (0.0..5.0f64, 0.1..4.0f64, prop_oneof![0.01..2.0f64, Just(1.0)]);
    prop_oneof![ordinary_tube(), general.prop_map(|(ell, i1, share)| Body::new(ell, i1, share * i1).unwrap())]
}

/// Random fillets of all sizes, from almost 0 to that of a ball.
pub fn any_fillet() -> impl Strategy<Value = f64> {
    prop_oneof![3 => 0.01..0.99f64, 2 => (-12.0..0.0f64).prop_map(|x| 10f64.powf(x)), 1 => Just(1.0)]
}

/// Random bodies of any moments on rounded rims; in a third of them the moments are equal or almost equal.
pub fn general_rounded() -> impl Strategy<Value = Body> {
    let ell = prop_oneof![4 => 0.0..3.0f64, 1 => Just(0.0), 1 => 3.0..30.0f64];
    let share = prop_oneof![4 => 0.05..2.0f64, 1 => Just(1.0), 1 => (-12.0..-3.0f64).prop_map(|x| 1.0 + 10f64.powf(x))];
    (ell, 0.1..4.0f64, share, any_fillet())
        .prop_map(|(ell, i1, share, fillet)| Body::rounded(ell, i1, share * i1, fillet).unwrap())
}

/// Random coins, cans and tubes with rounded edges, and capsules.
pub fn rounded_tube() -> impl Strategy<Value = Body> {
    let bore = prop_oneof![2 => Just(0.0), 1 => 0.0..0.9f64];
    let tube = (any_fillet(), prop_oneof![0.0..3.0f64, Just(0.0)], bore).prop_map(|(fillet, more, bore)| {
        let fillet = if bore > 0.0 { fillet.min(1.0 - bore) } else { fillet };
        Body::rounded_tube(fillet + more, bore, fillet).unwrap()
    });
    let capsule = (1.0..4.0f64).prop_map(|half| Body::rounded_tube(half, 0.0, 1.0).unwrap());
    prop_oneof![4 => tube, 1 => capsule]
}

/// Random balls: Hurricane balls, and balls whose centre of mass lies above or below their geometric centre.
pub fn any_ball() -> impl Strategy<Value = Body> {
    let twins = prop_oneof![Just(1.0), 1.0..3.0f64].prop_map(|x| Body::balls(x).unwrap());
    let loaded = (-0.95..0.95f64, 0.1..2.0f64, prop_oneof![0.2..2.0f64, Just(1.0)])
        .prop_map(|(offset, i1, share)| Body::ball(offset, i1, share * i1).unwrap());
    prop_oneof![1 => twins, 2 => loaded]
}

/// Random bodies with a fillet.
pub fn any_rounded() -> impl Strategy<Value = Body> {
    prop_oneof![3 => general_rounded(), 3 => rounded_tube(), 2 => any_ball()]
}

/// Random bodies; two of three have a fillet.
pub fn any_rim() -> impl Strategy<Value = Body> {
    prop_oneof![2 => any_rounded(), 1 => any_body()]
}

/// Random bodies: a third are tubes with a sharp rim, the others have a fillet.
pub fn tube_or_rounded() -> impl Strategy<Value = Body> {
    prop_oneof![2 => any_rounded(), 1 => ordinary_tube()]
}

/// Random states; in a third theta' is small or zero, in a third all numbers have one decimal.
pub fn any_state() -> impl Strategy<Value = State> {
    let slow =
        (-300.0..-4.0f64, any::<bool>()).prop_map(|(x, up)| 10f64.powf(x) * if up { 1.0 } else { -1.0 });
    let tilting = prop_oneof![4 => -2.0..2.0f64, 1 => Just(0.0), 1 => slow];
    (0.02..3.1f64, -4.0..4.0f64, tilting, -6.0..6.0f64, 0..3u8).prop_map(|(theta, w1, w2, w3, kind)| {
        let short = |x: f64| if kind == 0 { (10.0 * x).round() / 10.0 } else { x };
        let w2 = if w2.abs() > 0.1 { short(w2) } else { w2 };
        State { theta: short(theta).max(0.1), w1: short(w1), w2, w3: short(w3) }
    })
}

/// Time derivative of (theta, w1, w2, w3) from the three-dimensional equations of Newton and Euler in the
/// laboratory frame, with the contact as a linear system in the angular acceleration; shares no formula with
/// the library.
pub fn newton_euler(body: &Body, y: &State, contact: Contact) -> Vector4<f64> {
    let (s, c) = y.theta.sin_cos();
    let z = Vector3::z();
    let (e1, e2, e3) = (Vector3::new(c, 0.0, s), Vector3::y(), Vector3::new(-s, 0.0, c));
    let w = e1 * y.w1 + e2 * y.w2 + e3 * y.w3;
    let turning = z * (y.w1 / s) + e2 * y.w2;
    let axes = Matrix3::from_columns(&[e1, e2, e3]);
    let inertia =
        axes * Matrix3::from_diagonal(&Vector3::new(body.i1(), body.i1(), body.i3())) * axes.transpose();
    // the circle of the rim follows the axes; the contact lies the fillet straight below it
    let circle = -e1 * body.rim() - e3 * body.ell();
    let r = circle - z * body.fillet();
    let fixed = turning.cross(&circle).cross(&w);
    let gyro = w.cross(&(inertia * w));
    let cross = r.cross_matrix();
    let (matrix, known) = match contact {
        Contact::Rolling => (inertia - cross * cross, r.cross(&(fixed + z)) - gyro),
        _ => {
            let up = r.cross(&z);
            // (r x a) . z = -(r x z) . a
            (inertia + up * up.transpose(), up * (fixed.dot(&z) + 1.0) - gyro)
        }
    };
    let a = matrix.lu().solve(&known).expect("a body has inertia");
    let rate = |e: &Vector3<f64>| a.dot(e) + w.dot(&turning.cross(e));
    Vector4::new(-y.w2, rate(&e1), rate(&e2), rate(&e3))
}

/// Parses a double that is written as by %a in C, or as a decimal number.
pub fn number(text: &str) -> f64 {
    if text.contains("0x") { hex(text) } else { text.parse().unwrap() }
}

/// Parses a double that is written as by %a in C.
pub fn hex(text: &str) -> f64 {
    let (sign, rest) = text.strip_prefix('-').map_or((1.0, text), |rest| (-1.0, rest));
    if rest == "nan" {
        return f64::NAN;
    }
    let (digits, exponent) = rest.strip_prefix("0x").unwrap().split_once('p').unwrap();
    let (whole, part) = digits.split_once('.').unwrap_or((digits, ""));
    let mantissa = u64::from_str_radix(&format!("{whole}{part}"), 16).unwrap() as f64;
    let exponent = exponent.parse::<i32>().unwrap() - 4 * part.len() as i32;
    // in two steps, so that subnormal numbers are not rounded to zero on the way
    sign * mantissa * 2f64.powi(exponent / 2) * 2f64.powi(exponent - exponent / 2)
}

/// A row of `reference/motion.csv`: a motion, and its values at time `t` by the three-dimensional model.
///
/// `values` of a "period": theta_min, theta_max, phi and psi per period (t is the period); of a "state":
/// theta, w1, w2, w3, phi, psi, contact x, y, normal, friction; of an "event": theta, w1, w2, w3.
pub struct Reference {
    pub kind: String,
    pub scene: String,
    pub contact: Contact,
    pub body: Body,
    pub start: State,
    pub t: f64,
    pub values: Vec<f64>,
}

pub fn motions() -> Vec<Reference> {
    rows(include_str!("../../reference/motion.csv"), false)
}

/// Reference motions of bodies on rounded rims, `reference/rounded_motion.csv`; a "pole" is the state of a
/// ball that has passed its pole.
pub fn rounded_motions() -> Vec<Reference> {
    rows(include_str!("../../reference/rounded_motion.csv"), true)
}

/// Reference motions of both kinds of rim.
pub fn all_motions() -> impl Iterator<Item = Reference> {
    motions().into_iter().chain(rounded_motions())
}

fn rows(table: &str, rounded: bool) -> Vec<Reference> {
    let row = |line: &str| {
        let mut words = line.split(',');
        let mut word = || words.next().unwrap().to_string();
        let (kind, scene, contact) = (word(), word(), word());
        let mut x: Vec<f64> = words.map(number).collect();
        let fillet = if rounded { x.remove(3) } else { 0.0 };
        Reference {
            kind,
            scene,
            contact: if contact == "smooth" { Contact::Smooth } else { Contact::Rolling },
            body: Body::rounded(x[0], x[1], x[2], fillet).unwrap(),
            start: State::from([x[3], x[4], x[5], x[6]]),
            t: x[7],
            values: x[8..].to_vec(),
        }
    };
    table.lines().skip(1).map(row).collect()
}

pub const BOTH: [Contact; 2] = [Contact::Rolling, Contact::Smooth];

pub fn numbers(y: &State) -> [f64; 4] {
    (*y).into()
}

/// The larger of two numbers; NaN if one of them is NaN, which `f64::max` would ignore.
pub fn larger(a: f64, b: f64) -> f64 {
    if a.is_nan() || b <= a { a } else { b }
}

/// The largest difference between the components of two states; NaN if a component is NaN.
pub fn distance(a: &State, b: &[f64]) -> f64 {
    numbers(a).iter().zip(b).fold(0.0, |d, (a, b)| larger(d, (a - b).abs()))
}

pub fn state(theta: f64, w1: f64, w2: f64, w3: f64) -> State {
    State { theta, w1, w2, w3 }
}

/// Euler's disk: 75.1 mm wide, 13 mm thick, its edges rounded by 2 mm.
pub fn rounded_disk() -> Body {
    Body::from_metres(75.1, 0.0, 13.0, 2.0).unwrap()
}

/// A body of each kind of rounded rim, and a state from which it starts.
pub fn rounded_starts() -> [(Body, State); 5] {
    let can = Body::rounded_tube(1.0, 0.0, 0.1).unwrap();
    let fat = Body::rounded_tube(0.75, 0.0, 0.75).unwrap();
    let balls = Body::balls(1.0).unwrap();
    [
        (rounded_disk(), steady::state(&rounded_disk(), 0.38).unwrap().kicked(0.3)),
        (can, steady::state(&can, 0.5).unwrap().kicked(0.1)),
        (fat, state(0.9, 0.5, -0.4, 1.3)),
        (balls, steady::state(&balls, 1.4).unwrap().kicked(0.1)),
        (Body::ball(-0.2, 0.39, 0.4).unwrap(), state(1.2, 0.1, -1.3, 0.6)),
    ]
}

/// A cylinder on a sharp rim, and a state from which it starts.
pub fn sharp_start() -> (Body, State) {
    let body = Body::solid(1.0).unwrap();
    (body, steady::state(&body, 0.5).unwrap().kicked(0.3))
}

/// Starts on rounded rims and on a sharp rim.
pub fn starts() -> impl Iterator<Item = (Body, State)> {
    rounded_starts().into_iter().chain([sharp_start()])
}

/// The motion at these times, with the options `scene`.
pub fn moved(body: &Body, y: &State, times: &[f64], scene: Ask) -> Result<Motion, Error> {
    roll_with(body, y, times, &scene, || true).map(|m| m.expect("nobody interrupts"))
}

/// The path of a motion: the part of the result that only a motion with friction or losses has.
pub fn path_of(motion: &Motion) -> &Path {
    motion.path.as_deref().expect("friction or losses")
}

pub fn by(method: Method) -> Ask {
    Ask::default().with_method(method)
}

/// A generator of pseudo-random numbers in [0, 1); `k` is the seed.
pub fn wander(k: u64) -> impl FnMut() -> f64 {
    let mut x = k.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
    move || {
        x = x.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (x >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// A random theta' of 0, or of the size 1e-300 to 1e-4, with either sign.
pub fn almost_at_rest(r: &mut impl FnMut() -> f64) -> f64 {
    let size = if r() < 0.5 { 10f64.powf(-300.0 * r()) } else { 10f64.powf(-4.0 - 14.0 * r()) };
    if r() < 0.4 {
        0.0
    } else if r() < 0.5 {
        size.min(1e-4)
    } else {
        -size.min(1e-4)
    }
}

/// A random start: at any inclination, also beyond pi/2, with small or zero theta', with numbers of one decimal, or
/// near a steady state.
pub fn wild(r: &mut impl FnMut() -> f64) -> (Body, State, Contact) {
    loop {
        let ell = if r() < 0.2 { 0.0 } else { 3.0 * r() };
        let body = if r() < 0.7 {
            Body::tube(ell, r()).unwrap()
        } else {
            let i1 = 0.1 + 2.0 * r();
            Body::new(ell, i1, 2.0 * i1 * r().max(0.01)).unwrap()
        };
        let contact = if r() < 0.3 { Contact::Smooth } else { Contact::Rolling };
        let size = 10f64.powf(1.5 * r() - 1.0);
        let mut speed = || size * (2.0 * r() - 1.0);
        let start = state(0.0, speed(), speed(), speed());
        let w2 = if r() < 0.4 { almost_at_rest(r) } else { start.w2 };
        if r() < 0.5 {
            let short = r() < 0.3;
            let cut = |x: f64| if short { (10.0 * x).round() / 10.0 } else { x };
            let theta = cut(0.02 + 3.1 * r()).max(0.02);
            return (body, State { theta, w1: cut(start.w1), w2, w3: cut(start.w3) }, contact);
        }
        if let Ok(y) = steady::state(&body, 0.01 + 1.55 * r()) {
            return (body, y.kicked(10f64.powf(-12.0 * r())), contact);
        }
    }
}
