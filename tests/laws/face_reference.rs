//! Motions of a body on its face, landings on it and rises from it, compared with the references of
//! tests/reference/face.json.

use serde_json::{Value, from_str};
use spincyl::contact::Face;
use spincyl::contact::slip::Friction;
use spincyl::loss::{Law, Losses};
use spincyl::motion::path::Kind;
use spincyl::motion::{Ask, Ending, Motion, Start, roll_with};
use spincyl::{Body, Slip, State};
use std::f64::consts::TAU;

/// A motion of the reference table.
struct Case {
    name: String,
    body: Body,
    ask: Ask,
    start: Start,
    rows: Vec<Row>,
}

/// A row of the reference table: a time of a motion, with state, pose and friction.
struct Row {
    kind: String,
    time: f64,
    state: State,
    slip: [f64; 2],
    height: f64,
    heat: f64,
    work: f64,
    /// The pose: phi, psi, and the displacement of the centre of mass.
    pose: [f64; 4],
    /// The friction along the lean and across it; NaN unless the body is on its face.
    friction: [f64; 2],
}

/// The size below which a difference is that of double precision.
const TIGHT: f64 = 1e-11;

/// Converts a number of the reference table, where exact numbers have no quotes.
fn number(of: &Value) -> f64 {
    of.as_str().map_or_else(|| of.as_f64().unwrap(), |text| text.parse().unwrap())
}

fn numbers(of: &Value) -> Vec<f64> {
    of.as_array().unwrap().iter().map(number).collect()
}

fn table() -> Vec<Case> {
    let table: Value = from_str(include_str!("../reference/face.json")).unwrap();
    let columns: Vec<&str> =
        table["columns"].as_array().unwrap().iter().map(|x| x.as_str().unwrap()).collect();
    assert_eq!(columns.join(" "), "kind t theta w1 w2 w3 u_h u_2 height heat work phi psi x y f_h f_2");
    table["motions"].as_array().unwrap().iter().map(case).collect()
}

fn case(of: &Value) -> Case {
    let [ell, i1, i3, fillet] = numbers(&of["body"])[..] else { panic!("four numbers") };
    let body = if fillet == 0.0 { Body::new(ell, i1, i3) } else { Body::rounded(ell, i1, i3, fillet) };
    let friction = if of["law"] == "viscous" {
        Friction::Viscous { c: number(&of["mu"]) }
    } else {
        Friction::Coulomb { mu: number(&of["mu"]), fixed: number(&of["static"]), patch: 0.0 }
    };
    let laws = [Law::DryContour, Law::ViscousContour, Law::RollingResistance, Law::Drilling];
    let laws = laws.into_iter().chain([Law::AirLinear, Law::AirQuadratic]);
    let losses = laws.zip(numbers(&of["losses"])).fold(Losses::NONE, |all, (law, x)| all.with(law, x));
    let face = if of["face"] == "disc" { Face::Disc } else { Face::Ring };
    let ask = Ask::on(friction).with_losses(losses).with_face(face).with_pose().with_force();
    let [theta, w1, w2, w3, along, across] = numbers(&of["start"])[..] else { panic!("six numbers") };
    let start = Start::from(State { theta, w1, w2, w3 }).with_slip(Slip::new(along, across));
    let aloft = [number(&of["height"]), number(&of["lift"])];
    let row = |row: &Value| {
        let all = row.as_array().unwrap();
        let at: Vec<f64> = all[1..].iter().map(number).collect();
        Row {
            kind: all[0].as_str().unwrap().to_string(),
            time: at[0],
            state: State { theta: at[1], w1: at[2], w2: at[3], w3: at[4] },
            slip: [at[5], at[6]],
            height: at[7],
            heat: at[8],
            work: at[9],
            pose: [at[10], at[11], at[12], at[13]],
            friction: [at[14], at[15]],
        }
    };
    Case {
        name: of["name"].as_str().unwrap().to_string(),
        body: body.unwrap(),
        ask: ask.with_restitution(number(&of["restitution"])),
        start: start.with_aloft((aloft != [0.0; 2]).then_some(aloft.into())),
        rows: of["rows"].as_array().unwrap().iter().map(row).collect(),
    }
}

impl Case {
    fn samples(&self) -> impl Iterator<Item = &Row> {
        self.rows.iter().filter(|row| row.kind == "sample" || row.kind == "end")
    }

    /// Computes the motion at the first time, the times of the table, and a time after the end of a motion that comes
    /// to rest.
    fn rolled(&self) -> Motion {
        let mut times: Vec<f64> = [0.0].into_iter().chain(self.samples().map(|row| row.time)).collect();
        if self.rows.last().unwrap().kind == "rests" {
            times.push(self.rows.last().unwrap().time + 1.0);
        }
        let motion = roll_with(&self.body, self.start, &times, &self.ask, || true);
        motion.unwrap_or_else(|why| panic!("{}: {why}", self.name)).unwrap()
    }
}

/// The largest difference of two lists of numbers, over the size of each number if that is above 1.
fn most(found: &[f64], known: &[f64]) -> f64 {
    let each = found.iter().zip(known).map(|(a, b)| (a - b).abs() / b.abs().max(1.0));
    each.fold(0.0, |most: f64, x| if x <= most { most } else { x })
}

fn rests_of(found: f64, known: f64) -> f64 {
    let apart = found - known;
    (apart - (apart / TAU).round() * TAU).abs() / known.abs().max(1.0)
}

#[test]
fn states_slips_heat_and_poses_on_a_face_are_those_of_the_references() {
    let (mut count, mut worst) = (0, Vec::new());
    for case in table() {
        let m = case.rolled();
        let path = m.path.as_ref().unwrap();
        let name = &case.name;
        if m.states.len() != case.samples().count() + 1 {
            worst.push(format!("{name}: {} rows, {:?}", m.states.len(), m.event));
            continue;
        }
        let all: Vec<_> = m.samples().collect();
        let first = all[0].centre(&case.body).unwrap();
        for (i, row) in case.samples().enumerate() {
            let now = &all[i + 1];
            let State { theta, w1, w2, w3 } = now.state;
            let Slip { u_h: u, u_2: v, .. } = now.slip.unwrap();
            let known = [row.state.theta, row.state.w1, row.state.w2, row.state.w3, row.slip[0], row.slip[1]];
            let state =
                most(&[theta, w1, w2, w3, u, v], &known).max(most(&[now.aloft.height], &[row.height]));
            let struck: f64 =
                path.impacts.iter().filter(|hit| hit.time <= row.time).map(|hit| hit.lost).sum();
            let heat = (path.dissipated[i + 1] + struck - row.heat).abs();
            let work = path.work_lost.get(i + 1).map_or(0.0, |work| (work - row.work).abs());
            let (pose, centre) = (now.pose.unwrap(), now.centre(&case.body).unwrap());
            let [phi, psi] = [pose.phi.radians(), pose.psi.radians()];
            let mut place = most(&[centre.x - first.x, centre.y - first.y], &row.pose[2..])
                .max(rests_of(phi + psi, row.pose[0] + row.pose[1]));
            if row.friction[0].is_nan() && row.state.theta > 0.0 {
                place = place.max(rests_of(phi, row.pose[0]));
            }
            let force = now.force.map_or(f64::INFINITY, |force| {
                if row.friction[0].is_nan() {
                    0.0
                } else {
                    most(&[force.normal, force.across, force.along], &[1.0, row.friction[0], row.friction[1]])
                }
            });
            let (state_ok, pose_ok) = (TIGHT.max(m.error), TIGHT.max(m.pose_error));
            if !(state.max(heat).max(work) <= state_ok
                && place <= pose_ok
                && force <= TIGHT.max(m.force_error))
            {
                worst.push(format!(
                    "{name} at {}: state {state:.1e} heat {heat:.1e} work {work:.1e} of {:.1e}, pose {place:.1e} \
                     of {:.1e}, force {force:.1e} of {:.1e}",
                    row.time, m.error, m.pose_error, m.force_error
                ));
            }
        }
        count += 1;
    }
    assert!(worst.is_empty(), "{}", worst.join("\n"));
    assert!(count >= 16, "{count}");
}

#[test]
fn motions_on_a_face_end_where_those_of_the_references_do() {
    let (mut rests, mut worst) = (0, Vec::new());
    for case in table() {
        let (m, name) = (case.rolled(), &case.name);
        let last = case.rows.last().unwrap();
        let ok = TIGHT.max(m.error);
        if last.kind == "rests" {
            let late = m.event.map_or(f64::NAN, |event| (event.time - last.time).abs() / last.time.max(1.0));
            if m.ending() != Ending::Stops || late.is_nan() || late > ok {
                worst.push(format!("{name}: {:?}, late {late:.1e} of {:.1e}", m.ending(), m.error));
            }
            rests += 1;
        } else if m.ending() != Ending::Done {
            worst.push(format!("{name}: {:?}", m.event));
        }
        let path = m.path.as_ref().unwrap();
        for row in case.rows.iter().filter(|row| ["stands", "face", "rocked"].contains(&row.kind.as_str())) {
            let there = path.phases.iter().find(|phase| {
                phase.kind == Kind::OnItsFace && (phase.time - row.time).abs() <= ok * row.time.max(1.0)
            });
            if there.is_none() && row.time != last.time {
                worst.push(format!("{name}: nothing on its face at {}: {:?}", row.time, path.phases));
            }
        }
    }
    assert!(worst.is_empty(), "{}", worst.join("\n"));
    assert!(rests >= 13, "{rests}");
}
