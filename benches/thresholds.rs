//! The scenes of `tests/thresholds.py`: drawn by their number, and followed to their ends.
//!
//! ```text
//! thresholds draw 2000      a line for each scene: its kind, and its numbers
//! thresholds follow         of each line of the input its result: ending, time, phases, claimed error, last numbers
//! ```
//! The scenes are drawn once and followed by many versions of the library, so that all of them get the same numbers.
//! Twenty kinds take turns, and after 2,000 scenes five kinds of bodies that hop, fall or lie on their sides, and after 2,500
//! five on a patch of contact. Most of them are planted beside a decision: slips that hardly move, friction that is just
//! enough, faces that are all but down, losses that all but hold.

use spincyl::contact::{Friction, Table, TableKind, slip};
use spincyl::loss::{Law, Losses};
use spincyl::motion::{AboveTable, Ask, Event, Motion, Start, path::Path, roll_with};
use spincyl::stone::{self, StoneState};
use spincyl::{Body, Contact, Ellipsoid, Error, State, contact, steady};
use std::f64::consts::{FRAC_PI_2, PI};
use std::io::{BufRead, Write};

/// Kinds of scenes in which the body stays on the table, up to the number `ON_THE_TABLE`, and of those after them.
const ON_THE_TABLE: u64 = 2000;
const ALOFT: [&str; 5] = ["hops", "dropped", "bounces level", "lies", "rolls on its side"];
const AT_A_POINT: u64 = 2500;
const PATCHES: [&str; 5] =
    ["slips on a patch", "rolls on a patch", "drills on a patch", "top on a patch", "stone on a patch"];
const KINDS: [&str; 20] = [
    "slips",
    "rest",
    "slow slip",
    "planar",
    "viscous",
    "static",
    "grazes",
    "grazes later",
    "Painleve",
    "flat",
    "rolls and loses",
    "slips and loses",
    "whirr",
    "whirr that slips",
    "settles",
    "held",
    "comes to rest",
    "other rim",
    "stone",
    "stone that slips",
];

/// Random numbers of one scene, by splitmix64.
struct Draw(u64);

impl Draw {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let x = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let x = (x ^ (x >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        x ^ (x >> 31)
    }

    fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// A number whose logarithm is uniform, between two powers of ten.
    fn power(&mut self, low: f64, high: f64) -> f64 {
        10f64.powf(self.within(low, high))
    }

    fn sign(&mut self) -> f64 {
        if self.happens(0.5) { 1.0 } else { -1.0 }
    }

    fn happens(&mut self, chance: f64) -> bool {
        self.within(0.0, 1.0) < chance
    }

    fn of<T: Copy>(&mut self, all: &[T]) -> T {
        all[(self.next() % all.len() as u64) as usize]
    }

    /// About normal, between -3 and 3.
    fn normal(&mut self) -> f64 {
        (0..4).map(|_| self.within(-0.75, 0.75)).sum::<f64>() * 1.15
    }
}

/// A body or a stone on a table, at its start.
struct Scene {
    /// ell, I1, I3, fillet and theta_end of a body; the 13 numbers of a stone.
    body: Vec<f64>,
    table: [f64; 4],
    losses: [f64; 8],
    /// NaN for None, which ends a motion where the body leaves the table or its other rim lands.
    restitution: f64,
    /// Height and velocity of the lowest point of a body in the air; NaN on the table.
    aloft: [f64; 2],
    /// theta and w of a body, the vertical and w of a stone; and the slip.
    start: Vec<f64>,
    slip: [f64; 2],
    end: f64,
}

impl Scene {
    fn of(body: &Body, table: Table, y: State, end: f64) -> Self {
        Self {
            body: vec![body.ell(), body.i1(), body.i3(), body.fillet(), body.theta_end()],
            table: numbers_of(table),
            losses: [0.0; 8],
            restitution: f64::NAN,
            aloft: [f64::NAN; 2],
            start: vec![y.theta, y.w1, y.w2, y.w3],
            slip: [0.0; 2],
            end,
        }
    }

    fn numbers(&self) -> Vec<f64> {
        let mut all = vec![self.body.len() as f64];
        all.extend(&self.body);
        all.extend(self.table);
        all.extend(self.losses);
        all.push(self.restitution);
        all.extend(self.aloft);
        all.extend(&self.start);
        all.extend(self.slip);
        all.push(self.end);
        all
    }

    fn of_numbers(all: &[f64]) -> Self {
        let mut rest = all[1..].iter().copied();
        let mut take = |count: usize| -> Vec<f64> { rest.by_ref().take(count).collect() };
        let body = take(all[0] as usize);
        let start = if body.len() == 5 { 4 } else { 6 };
        let (table, losses, restitution, aloft) = (take(4), take(8), take(1)[0], take(2));
        let [start, slip, end] = [take(start), take(2), take(1)];
        Self {
            body,
            table: table.try_into().unwrap(),
            losses: losses.try_into().unwrap(),
            restitution,
            aloft: aloft.try_into().unwrap(),
            start,
            slip: slip.try_into().unwrap(),
            end: end[0],
        }
    }

    fn ask(&self) -> Ask {
        let all = Law::ALL.iter().zip(self.losses);
        let losses = all.fold(Losses::NONE, |sum, (law, x)| sum.with(*law, x));
        let restitution = Some(self.restitution).filter(|e| !e.is_nan());
        Ask::on(table_of(self.table)).with_losses(losses).with_restitution(restitution)
    }

    fn follow(&self) -> Result<String, Error> {
        let times = [0.5 * self.end, self.end];
        let slip = self.slip;
        if self.body.len() == 5 {
            let [ell, i1, i3, fillet, theta_end] = self.body[..] else { unreachable!() };
            let body = Body::rounded(ell, i1, i3, fillet)?.with_theta_end(theta_end)?;
            let [theta, w1, w2, w3] = self.start[..] else { unreachable!() };
            let aloft = Some(AboveTable::from(self.aloft)).filter(|aloft| !aloft.height.is_nan());
            let start = Start::from(State { theta, w1, w2, w3 }).with_slip(slip.into()).with_aloft(aloft);
            let found = roll_with(&body, start, &times, &self.ask(), || true)?.unwrap();
            Ok(told(&found, |y| vec![y.theta, y.w1, y.w2, y.w3]))
        } else {
            let stone = Ellipsoid::of_numbers(self.body[..].try_into().unwrap())?;
            let [a, b, c, d, e, f] = self.start[..] else { unreachable!() };
            let start = Start::from(StoneState { vertical: [a, b, c], w: [d, e, f] }).with_slip(slip.into());
            let found = stone::roll(&stone, start, &times, &self.ask(), || true)?.unwrap();
            Ok(told(&found, |y| [y.vertical, y.w].concat()))
        }
    }
}

/// The result of a motion in a line.
fn told<S: spincyl::motion::Moving>(found: &Motion<S>, numbers: impl Fn(&S) -> Vec<f64>) -> String {
    let path: Option<&Path<S>> = found.path.as_deref();
    let (ending, time, last) = match &found.event {
        Some(Event { ending, time, state, .. }) => (format!("{ending:?}"), *time, numbers(state)),
        None => ("Done".into(), *found.times.last().unwrap(), numbers(found.states.last().unwrap())),
    };
    let slip = match (path, &found.event) {
        (Some(path), Some(_)) => path.last_slip.into(),
        (Some(path), None) => (*path.slip.last().unwrap()).into(),
        _ => [0.0; 2],
    };
    let phases = path.map_or(1, |path| path.phases.len());
    let last: Vec<String> = last.iter().chain(&slip).map(|x| format!("{x:e}")).collect();
    format!("{ending} {time:e} {phases} {:e} {}", found.error, last.join(" "))
}

/// The table of these numbers.
fn table_of([kind, a, fixed, patch]: [f64; 4]) -> Table {
    match TableKind::from_code(kind as u8) {
        Some(TableKind::Rolling) => Table::Rolling { mu: a },
        Some(TableKind::Coulomb) => Friction::Coulomb { mu: a, fixed, patch }.into(),
        Some(TableKind::Viscous) => Friction::Viscous { c: a }.into(),
        _ => Table::Smooth,
    }
}

/// The kind of the table, its one or two coefficients, and the radius of a patch.
fn numbers_of(table: Table) -> [f64; 4] {
    match table {
        Table::Rolling { mu } => [0.0, mu, 0.0, 0.0],
        Table::Smooth => [1.0, 0.0, 0.0, 0.0],
        Table::Rubs(Friction::Coulomb { mu, fixed, patch }) => [2.0, mu, fixed, patch],
        Table::Rubs(Friction::Viscous { c }) => [3.0, c, 0.0, 0.0],
        _ => [f64::NAN; 4],
    }
}

/// Tubes, disks, rods, rounded and light bodies, and balls if they are wanted.
fn body(draw: &mut Draw, balls: bool) -> Body {
    let i1 = draw.within(0.2, 1.5);
    let share = draw.within(0.2, 1.6);
    let bore = if draw.happens(0.4) { 0.0 } else { draw.within(0.0, 1.0) };
    match draw.of(&["tube", "disk", "rod", "rounded", "light", "ball"]) {
        "disk" => Body::tube(draw.within(0.0, 0.3), bore),
        "rod" => Body::tube(draw.power(0.5, 1.3), bore),
        "rounded" => Body::rounded(draw.within(0.0, 2.0), i1, share * i1, draw.within(0.02, 0.9)),
        "light" => {
            let light = draw.power(-2.0, -0.5);
            Body::new(draw.within(0.2, 2.0), light, draw.within(0.2, 1.9) * light)
        }
        "ball" if balls => Body::ball(draw.within(-0.6, 0.6), i1, share * i1),
        _ => Body::tube(draw.within(0.3, 6.0), bore),
    }
    .unwrap()
}

/// A disk or a short tube.
fn coin(draw: &mut Draw) -> Body {
    let bore = if draw.happens(0.7) { 0.0 } else { draw.within(0.0, 0.9) };
    let ell = if draw.happens(0.3) { 0.0 } else { draw.power(-3.0, -0.5) };
    Body::tube(ell, bore).unwrap()
}

/// A state, mostly one in which the table presses on a body that rolls.
fn state(draw: &mut Draw, body: &Body) -> State {
    let most = if draw.happens(0.05) { 1 } else { 30 };
    for tries in 1.. {
        let size = draw.power(-1.0, 0.3);
        let flat = draw.happens(0.1);
        let theta = if flat { draw.power(-3.0, -1.3) } else { draw.within(0.05, FRAC_PI_2 - 0.02) };
        let [w1, w2, w3] = [size * draw.normal(), size * draw.normal(), size * draw.normal()];
        let w2 = if draw.happens(0.3) { 0.0 } else { w2 };
        let y = State { theta, w1: if theta < 0.05 { w1 * theta } else { w1 }, w2, w3 };
        if tries == most || contact::force(Contact::Rolling, body, &y).normal > 0.1 {
            return y;
        }
    }
    unreachable!("the last try is taken")
}

/// A state at which a body that nods about a steady state turns, and the friction that rolling needs is extreme.
fn turning(draw: &mut Draw, balls: bool) -> (Body, State) {
    loop {
        let of = body(draw, balls);
        let theta = draw.within(0.1, FRAC_PI_2 - 0.1);
        let off = draw.sign() * draw.power(-3.0, -1.2);
        if let Ok(y) = steady::state(&of, theta)
            && contact::force(Contact::Rolling, &of, &y).normal > 0.1
        {
            return (of, State { theta: theta + off, w2: 0.0, ..y });
        }
    }
}

/// The state of a body that rolls, after the time `t`; None if its motion has ended before.
fn moved(body: &Body, y: &State, t: f64) -> Option<State> {
    let found = roll_with(body, *y, &[t], &Ask::default(), || true).ok()??;
    found.states.first().copied().filter(|_| found.event.is_none())
}

/// How much friction per normal force rolling needs.
fn needs(body: &Body, y: &State) -> f64 {
    let force = contact::force(Contact::Rolling, body, y);
    if force.normal > 0.0 { force.friction_coefficient() } else { f64::INFINITY }
}

/// A coin that whirrs: almost flat, with the precession of a steady state, and a nutation.
fn whirring(draw: &mut Draw, body: &Body, theta: f64) -> State {
    let (s, c) = theta.sin_cos();
    let (n, d) = (c - body.ell() * s, body.i1() / body.i3() - 1.0);
    let rate = (n.max(1e-3) / ((n + d * c) * s).max(1e-9)).sqrt();
    let w1 = rate * s * (1.0 + if draw.happens(0.5) { 0.0 } else { 0.2 * draw.normal() });
    let w2 = if draw.happens(0.5) { 0.0 } else { s.sqrt() * 0.3 * draw.normal() };
    State { theta, w1, w2, w3: body.ell() * rate * s + s * draw.normal() }
}

fn turned(draw: &mut Draw, size: f64) -> [f64; 2] {
    let (sin, cos) = draw.within(-PI, PI).sin_cos();
    [size * cos, size * sin]
}

fn dry(draw: &mut Draw) -> Friction {
    let mu = draw.power(-1.3, 0.3);
    let fixed = if draw.happens(0.3) { mu * draw.within(1.02, 1.5) } else { mu };
    Friction::Coulomb { mu, fixed, patch: 0.0 }
}

/// Up to `most` laws of the numbers `laws`.
fn losses(draw: &mut Draw, laws: &[usize], most: u64) -> [f64; 8] {
    let mut all = [0.0; 8];
    for _ in 0..=draw.next() % most {
        all[draw.of(laws)] = draw.power(-4.0, -0.7);
    }
    all
}

/// A number beside 1: exactly 1, or away from it by 1e-15 to 1e-4 on either side.
fn beside_one(draw: &mut Draw) -> f64 {
    if draw.happens(0.15) { 1.0 } else { 1.0 + draw.sign() * draw.power(-15.0, -4.0) }
}

fn stone_of(draw: &mut Draw) -> Ellipsoid {
    loop {
        let axes = [1.0, draw.within(0.2, 1.0), draw.within(0.15, 1.0)];
        let found = match draw.next() % 4 {
            0 => {
                let axes = [1.0, draw.within(0.1, 0.5), draw.within(0.1, 0.5)];
                Ellipsoid::rattleback(axes, None, draw.within(-0.2, 0.2), None)
            }
            1 => Ellipsoid::egg(draw.within(0.3, 0.9), 1.0, draw.within(-0.1, 0.1)),
            _ => Ellipsoid::uniform(axes),
        };
        let edge = draw.happens(0.3).then(|| draw.within(0.3, 2.5));
        if let Ok(stone) = found.and_then(|stone| edge.map_or(Ok(stone), |edge| stone.with_theta_end(edge))) {
            return stone;
        }
    }
}

fn stone_scene(draw: &mut Draw, slips: bool) -> Scene {
    let stone = stone_of(draw);
    let mut n = [0.4 * draw.normal(), 0.4 * draw.normal(), draw.within(0.2, 1.0)];
    if draw.happens(0.2) {
        n = [draw.power(-12.0, -2.0), draw.power(-12.0, -2.0), 1.0];
    }
    let long = n.iter().map(|x| x * x).sum::<f64>().sqrt();
    let n = n.map(|x| x / long);
    let size = draw.of(&[0.0, 1e-9, 0.3, 1.0, 1.0]);
    let mut w = [draw.normal(), draw.normal(), draw.normal()].map(|x| size * x);
    if draw.happens(0.3) {
        let spin = 2.0 * draw.normal();
        w = n.map(|x| x * spin);
    }
    let (table, slip): (Table, _) = if slips {
        let slip = if draw.happens(0.3) { 0.0 } else { draw.power(-14.0, 0.3) };
        let friction =
            if draw.happens(0.1) { Friction::Viscous { c: draw.power(-2.0, 1.0) } } else { dry(draw) };
        let much = if draw.happens(0.2) { draw.within(1.0, 8.0) } else { 1.0 };
        let friction = match friction {
            Friction::Coulomb { mu, fixed, patch } => {
                Friction::Coulomb { mu: much * mu, fixed: much * fixed, patch }
            }
            other => other,
        };
        (friction.into(), turned(draw, slip))
    } else {
        let mu = draw.of(&[f64::INFINITY, 0.2, 0.6, 1.5]);
        (if draw.happens(0.2) { Table::Smooth } else { Table::Rolling { mu } }, [0.0; 2])
    };
    Scene {
        body: stone.numbers().to_vec(),
        table: numbers_of(table),
        losses: [0.0; 8],
        restitution: f64::NAN,
        aloft: [f64::NAN; 2],
        start: [n, w].concat(),
        slip,
        end: 8.0,
    }
}

/// The kind of the scene of a number.
fn kind(number: u64) -> &'static str {
    let of = |all: &[&'static str]| all[(number % all.len() as u64) as usize];
    match number {
        ..ON_THE_TABLE => of(&KINDS),
        ON_THE_TABLE..AT_A_POINT => of(&ALOFT),
        _ => of(&PATCHES),
    }
}

/// The scene of a body or a stone on a patch of contact.
fn patch_scene(draw: &mut Draw, kind: &str) -> Scene {
    let patch = if draw.happens(0.7) { draw.power(-4.0, -0.7) } else { draw.power(-9.0, -4.0) };
    let on = |mu: f64, share: f64| Table::from(Friction::Coulomb { mu, fixed: mu * share, patch });
    let share = if draw.happens(0.7) { 1.0 } else { draw.within(1.02, 1.5) };
    let mu = draw.power(-1.3, 0.0);
    if kind == "stone on a patch" {
        let mut all = stone_scene(draw, true);
        if all.table[0] == 2.0 {
            all.table[3] = patch;
        }
        return all;
    }
    let (of, mut y) = if kind == "top on a patch" {
        let top = Body::ball(draw.within(-0.3, -0.05), 0.4, draw.within(0.36, 0.44)).unwrap();
        (top, State { theta: draw.power(-2.0, 0.0), w1: 0.0, w2: 0.0, w3: draw.within(1.0, 8.0) })
    } else {
        let of = body(draw, true);
        (of, state(draw, &of))
    };
    let (s, c) = y.theta.sin_cos();
    let (drilling, along) = (s * y.w1 + c * y.w3, c * y.w1 - s * y.w3);
    // A drilling that vanishes, or all but does.
    if kind == "drills on a patch" {
        let drilling = draw.of(&[0.0, 0.5, 1.0, 1.5, 2.0, 3.0]) * 1e-10 * draw.sign();
        (y.w1, y.w3) = (s * drilling + c * along, c * drilling - s * along);
    }
    let slip = match kind {
        "slips on a patch" => {
            patch * drilling.abs() * beside_one(draw) * draw.of(&[0.1, 0.999, 1.0, 1.0, 3.0])
        }
        "drills on a patch" => draw.of(&[0.0, 0.0, 1e-12, 1e-9]) * patch,
        "top on a patch" => draw.of(&[0.0, 1.0]) * draw.power(-3.0, 0.5),
        _ => 0.0,
    };
    // Friction that is just enough for rolling, or just not.
    let needed = needs(&of, &y);
    let enough = kind == "rolls on a patch" && needed.is_finite() && draw.happens(0.5);
    let mu = if enough { (needed * beside_one(draw)).clamp(1e-3, 3.0) } else { mu };
    let end = if kind == "top on a patch" { 20.0 } else { 5.0 };
    Scene { slip: turned(draw, slip), ..Scene::of(&of, on(mu, share), y, end) }
}

/// The scene of a body that may leave the table or lie on its side.
fn aloft_scene(draw: &mut Draw, kind: &str) -> Scene {
    let of = match draw.next() % 3 {
        0 => Body::tube(draw.within(0.02, 6.0), draw.within(0.0, 1.0)),
        1 => Body::tube(draw.within(0.02, 2.0), 0.0),
        _ => Body::rounded(draw.within(0.1, 2.0), draw.within(0.3, 1.5), draw.within(0.2, 0.6), 0.0),
    }
    .unwrap();
    let table = if draw.happens(0.2) { Friction::Viscous { c: draw.power(-1.0, 1.0) } } else { dry(draw) };
    let fast = draw.power(-0.5, 0.7);
    let [w1, w2, w3] = [fast * draw.normal(), fast * draw.normal(), fast * draw.normal()];
    let leans = draw.within(0.05, FRAC_PI_2 - 0.02);
    let nearly = FRAC_PI_2 - if draw.happens(0.3) { 0.0 } else { draw.power(-13.0, -3.0) };
    let size = if draw.happens(0.3) { 0.0 } else { draw.power(-14.0, 0.3) };
    let restitution = draw.of(&[0.0, 0.0, 0.3, 0.7]);
    let height = if draw.happens(0.2) { 0.0 } else { draw.power(-8.0, 0.5) };
    let lift = if draw.happens(0.3) { draw.power(-8.0, 0.0) } else { 0.0 };
    let (y, aloft) = match kind {
        "hops" => (State { theta: leans, w1: 2.0 * w1, w2, w3 }, [f64::NAN; 2]),
        "dropped" => (State { theta: leans, w1, w2, w3 }, [height, lift]),
        "bounces level" => (State { theta: nearly, w1, w2: 1e-3 * w2, w3 }, [height, lift]),
        "lies" => (State { theta: FRAC_PI_2, w1, w2: 0.0, w3 }, [f64::NAN; 2]),
        // A roller that sticks on one rim, or rolls straight.
        _ => {
            let w1 = draw.of(&[0.0, 1e-13, 1e-9, w1]);
            (State { theta: FRAC_PI_2, w1, w2: 0.0, w3 }, [f64::NAN; 2])
        }
    };
    let losses = if draw.happens(0.4) { losses(draw, &[0, 1, 2, 3, 4, 5, 6, 7], 2) } else { [0.0; 8] };
    let slip = if kind == "rolls on its side" { [0.0; 2] } else { turned(draw, size) };
    Scene { losses, restitution, aloft, slip, ..Scene::of(&of, table.into(), y, 6.0) }
}

/// The scene of a number, of the kind of that number.
fn scene(number: u64) -> Scene {
    let mut draws = Draw(number);
    let draw = &mut draws;
    match number {
        ..ON_THE_TABLE => {}
        ON_THE_TABLE..AT_A_POINT => return aloft_scene(draw, kind(number)),
        _ => return patch_scene(draw, kind(number)),
    }
    let (rolling, three) = (Table::default(), 3.0);
    match kind(number) {
        "slips" => {
            let size = draw.power(-1.5, 0.5);
            let of = body(draw, true);
            let all = Scene::of(&of, dry(draw).into(), state(draw, &of), three);
            Scene { slip: turned(draw, size), ..all }
        }
        "rest" => {
            let of = body(draw, true);
            Scene::of(&of, dry(draw).into(), state(draw, &of), three)
        }
        "slow slip" => {
            let size = draw.power(-15.0, -1.5);
            let of = body(draw, true);
            let all = Scene::of(&of, dry(draw).into(), state(draw, &of), three);
            Scene { slip: turned(draw, size), ..all }
        }
        "planar" => {
            let size = draw.power(-13.0, 0.3);
            let of = body(draw, true);
            let y = state(draw, &of);
            let all = Scene::of(&of, dry(draw).into(), State { w1: 0.0, w3: 0.0, ..y }, three);
            let losses = if draw.happens(0.5) { losses(draw, &[0, 2, 3, 4], 2) } else { [0.0; 8] };
            Scene { slip: [draw.of(&[0.0, size, -size]), 0.0], losses, ..all }
        }
        "viscous" => {
            let (size, c) = (draw.power(-3.0, 0.3), draw.power(-2.0, 1.0));
            let of = body(draw, false);
            let all = Scene::of(&of, Friction::Viscous { c }.into(), state(draw, &of), three);
            let losses =
                if draw.happens(0.5) { losses(draw, &[0, 1, 2, 3, 4, 5, 6, 7], 3) } else { [0.0; 8] };
            Scene { slip: turned(draw, size), losses, ..all }
        }
        // Static friction that rolling needs exactly, or all but exactly, at the start.
        "static" => loop {
            let of = body(draw, true);
            let y = state(draw, &of);
            let needs = needs(&of, &y);
            if needs > 1e-3 && needs < 3.0 {
                let fixed = needs * beside_one(draw);
                let mu = if draw.happens(0.5) { fixed } else { fixed * draw.within(0.5, 1.0) };
                break Scene::of(&of, Friction::Coulomb { mu, fixed, patch: 0.0 }.into(), y, three);
            }
        },
        // The largest friction of a nutation, at the start, is all but what the table gives.
        "grazes" => loop {
            let (of, y) = turning(draw, true);
            let Some(later) = moved(&of, &y, 0.02) else { continue };
            let (needs, then) = (needs(&of, &y), needs(&of, &later));
            if needs > 1e-6 && needs < 5.0 && then < needs {
                let mu = needs * beside_one(draw);
                break Scene::of(&of, Table::Rolling { mu }, y, three);
            }
        },
        // The same, after some time.
        "grazes later" => loop {
            let (of, y) = turning(draw, true);
            let before = -draw.within(0.2, 2.0);
            let [Some(start), Some(near)] = [before, -0.02].map(|t| moved(&of, &y, t)) else { continue };
            let (needs, then) = (needs(&of, &y), needs(&of, &near));
            if needs > 1e-6 && needs < 5.0 && then < needs {
                let mu = needs * beside_one(draw);
                let table =
                    if draw.happens(0.5) { Table::Rolling { mu } } else { Friction::coulomb(mu).into() };
                break Scene::of(&of, table, start, three);
            }
        },
        "Painleve" => loop {
            let of = body(draw, true);
            let y = state(draw, &of);
            let least = slip::painleve(&of, y.theta);
            let share = if draw.happens(0.5) {
                draw.within(0.6, 1.05)
            } else {
                beside_one(draw) * draw.of(&[0.9, 1.0])
            };
            if least * share < 20.0 {
                let size = if draw.happens(0.5) { 0.0 } else { draw.power(-12.0, 0.5) };
                let all = Scene::of(&of, Friction::coulomb(least * share).into(), y, three);
                break Scene { slip: turned(draw, size), ..all };
            }
        },
        "flat" => {
            let (of, theta) = (body(draw, true), draw.power(-8.0, -2.0));
            let mut y = whirring(draw, &of, theta);
            if draw.happens(0.5) {
                y = State {
                    w1: draw.power(-12.0, 0.0) * theta,
                    w2: draw.power(-6.0, -1.0),
                    w3: draw.normal(),
                    ..y
                };
            }
            let dry = dry(draw).into();
            let table = draw.of(&[rolling, Table::Smooth, Table::Rolling { mu: 0.3 }, dry]);
            Scene::of(&of, table, y, three)
        }
        "rolls and loses" => {
            let of = body(draw, false);
            let y = state(draw, &of);
            let mu = draw.of(&[f64::INFINITY, 0.3, 1.0]);
            let table = if draw.happens(0.3) { Table::Smooth } else { Table::Rolling { mu } };
            Scene { losses: losses(draw, &[0, 1, 2, 3, 4, 5, 6, 7], 3), ..Scene::of(&of, table, y, 5.0) }
        }
        "slips and loses" => {
            let (of, size) = (body(draw, false), draw.power(-6.0, 0.3));
            let y = state(draw, &of);
            let all = Scene::of(&of, dry(draw).into(), y, 5.0);
            let slip = if draw.happens(0.4) { [0.0; 2] } else { turned(draw, size) };
            Scene { slip, losses: losses(draw, &[0, 1, 2, 3, 4, 5, 6, 7], 3), ..all }
        }
        "whirr" => {
            let (of, theta) = (coin(draw), draw.power(-3.0, -0.7));
            let y = whirring(draw, &of, theta);
            let table = if draw.happens(0.2) { Table::Smooth } else { rolling };
            let mut losses = losses(draw, &[0, 1, 2, 3, 4, 6, 7], 2);
            losses.iter_mut().for_each(|x| *x *= 0.1);
            Scene { losses, ..Scene::of(&of, table, y, 30.0) }
        }
        "whirr that slips" => {
            let (of, theta) = (coin(draw), draw.power(-3.5, -1.0));
            let (y, mu) = (whirring(draw, &of, theta), draw.power(-2.0, -0.5));
            let losses = losses(draw, &[2, 3], 2);
            Scene { losses, ..Scene::of(&of, Friction::coulomb(mu).into(), y, 4.0) }
        }
        "settles" => {
            let (of, theta) = (coin(draw), draw.power(-5.0, -1.0));
            let drop = State {
                theta,
                w1: 0.1 * draw.normal() * theta,
                w2: draw.power(-3.0, -1.0),
                w3: 0.1 * draw.normal(),
            };
            let y = if draw.happens(0.5) { drop } else { whirring(draw, &of, theta) };
            let mut losses = losses(draw, &[1, 6, 6, 7, 7], 1);
            if draw.happens(0.4) {
                losses[0] = draw.power(-3.0, -1.0);
            }
            if draw.happens(0.2) {
                losses[3] = draw.power(-3.0, -1.0);
            }
            let dry = dry(draw).into();
            let table = draw.of(&[rolling, Table::Smooth, dry]);
            Scene { losses, ..Scene::of(&of, table, y, 30.0) }
        }
        // psi' or w_z vanishes at the start, and a dry loss holds it or all but holds it.
        "held" => {
            let of = body(draw, false);
            let mut y = state(draw, &of);
            let (s, c) = y.theta.sin_cos();
            if draw.happens(0.5) {
                y.w3 = y.w1 * c / s;
            } else {
                y.w3 = -y.w1 * s / c;
            }
            if draw.happens(0.2) {
                (y.w1, y.w3) = (0.0, 0.0);
            }
            let mut losses = losses(draw, &[0, 0, 3, 3, 2], 2);
            losses.iter_mut().for_each(|x| *x *= 3.0);
            let mu = draw.power(-1.0, 0.0);
            let table =
                draw.of(&[rolling, Table::Rolling { mu }, Friction::coulomb(mu).into(), Table::Smooth]);
            Scene { losses, ..Scene::of(&of, table, y, 5.0) }
        }
        "comes to rest" => {
            let i1 = draw.within(0.3, 0.5);
            let ball = Body::ball(draw.of(&[0.0, 0.1, -0.1]), i1, i1).unwrap();
            let of = if draw.happens(0.5) { ball } else { body(draw, false) };
            let y = State { theta: draw.within(0.2, FRAC_PI_2), ..state(draw, &of) };
            let y = if draw.happens(0.3) { State { w1: 0.0, w3: 0.0, ..y } } else { y };
            let mut losses = losses(draw, &[2, 2, 3, 0], 2);
            losses[2] = draw.power(-1.5, 0.0);
            let mu = draw.power(-1.0, 0.0);
            let table = draw.of(&[rolling, Friction::coulomb(mu).into()]);
            Scene { losses, ..Scene::of(&of, table, y, 20.0) }
        }
        "other rim" => {
            let bore = if draw.happens(0.5) { 0.0 } else { draw.within(0.0, 1.0) };
            let of = Body::tube(draw.within(0.1, 6.0), bore).unwrap();
            let below = if draw.happens(0.3) { 0.0 } else { draw.power(-12.0, -1.0) };
            let w2 = if below == 0.0 { draw.of(&[0.0, 1e-12, 1e-9]) } else { -draw.power(-12.0, -0.5) };
            let (w1, w3) = (draw.normal(), draw.normal() * (1.0 + of.ell()));
            let all = Scene::of(&of, dry(draw).into(), State { theta: FRAC_PI_2 - below, w1, w2, w3 }, three);
            let size = draw.power(-8.0, 0.3);
            let slip = if draw.happens(0.3) { [0.0; 2] } else { turned(draw, size) };
            Scene { slip, restitution: 0.0, ..all }
        }
        "stone" => stone_scene(draw, false),
        _ => stone_scene(draw, true),
    }
}

fn main() {
    let words: Vec<String> = std::env::args().collect();
    let mut out = std::io::BufWriter::new(std::io::stdout().lock());
    if words[1] == "draw" {
        for number in 0..words[2].parse().unwrap() {
            let numbers: Vec<String> = scene(number).numbers().iter().map(|x| format!("{x:e}")).collect();
            let kind = kind(number).replace(' ', "-");
            writeln!(out, "{kind} {}", numbers.join(" ")).unwrap();
        }
        return;
    }
    for line in std::io::stdin().lock().lines() {
        let line = line.unwrap();
        let numbers: Vec<f64> = line.split(' ').skip(1).map(|x| x.parse().unwrap()).collect();
        let result = Scene::of_numbers(&numbers).follow();
        let said = result.unwrap_or_else(|error| {
            let words = format!("{error:?}");
            let name: String = words.chars().take_while(|x| x.is_alphanumeric()).collect();
            format!("{name} 0 0 0")
        });
        writeln!(out, "{said}").unwrap();
    }
}
