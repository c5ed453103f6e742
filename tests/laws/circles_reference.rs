//! Motions of bodies with several circles of contact, compared with the references of tests/reference/rims.py, with
//! states counted from either end of the body.

use serde_json::{Value, from_str};
use spincyl::body::Circle;
use spincyl::contact::slip::Friction;
use spincyl::loss::{Law, Losses};
use spincyl::motion::path::Kind;
use spincyl::motion::{Ask, Ending, Motion, Start, roll_with};
use spincyl::{Body, Slip, State};
use std::f64::consts::{PI, TAU};

/// A motion of the reference table.
struct Case {
    name: String,
    circles: Vec<Circle>,
    moments: [f64; 2],
    ask: Ask,
    start: Told,
    /// The rate along the lean of a body that rolls round its apex from the start.
    apex: Option<f64>,
    rows: Vec<Row>,
}

/// A row of the reference table: a time of a motion, with state, slip and forces.
struct Row {
    kind: String,
    time: f64,
    told: Told,
    heat: f64,
    work: f64,
}

/// A state that is counted from one of the body's circles, and from one of its ends.
#[derive(Debug, Clone, Copy)]
struct Told {
    circle: usize,
    /// The index and the slip of the other circle, if two circles touch the table.
    other: Option<(usize, [f64; 2])>,
    state: State,
    slip: [f64; 2],
    /// The pose: phi, psi, and the contact point (x, y) of the circle.
    pose: [f64; 4],
}

/// The size below which a difference is that of double precision.
const TIGHT: f64 = 1e-11;

/// Radius, depth, lever and height of a circle at an inclination.
fn touching(circle: &Circle, theta: f64) -> [f64; 4] {
    let (s, c) = theta.sin_cos();
    let Circle { radius, depth, fillet } = *circle;
    [radius + fillet * s, depth + fillet * c, depth * s - radius * c, depth * c + radius * s + fillet]
}

impl Told {
    /// The same body with its state counted from the circle `k`, which is at the same height.
    fn told_from_circle(self, k: usize, circles: &[Circle]) -> Self {
        if k == self.circle {
            return self;
        }
        let State { theta, w1, w2, w3 } = self.state;
        let [a, l, g, z] = touching(&circles[self.circle], theta);
        let [a1, l1, g1, z1] = touching(&circles[k], theta);
        let [u_h, u_2] = self.slip;
        let [phi, psi, x, y] = self.pose;
        let apart = g1 - g;
        Self {
            circle: k,
            other: self.other.map(|_| (self.circle, self.slip)),
            slip: [u_h + (z - z1) * w2, u_2 + (l1 - l) * w1 - (a1 - a) * w3],
            pose: [phi, psi, x + apart * phi.cos(), y + apart * phi.sin()],
            ..self
        }
    }

    /// The same body with its state counted from its other end.
    fn told_from_other_end(self, count: usize) -> Self {
        let back = |slip: [f64; 2]| slip.map(|u| 0.0 - u);
        let State { theta, w1, w2, w3 } = self.state;
        let [phi, psi, x, y] = self.pose;
        Self {
            circle: count - 1 - self.circle,
            other: self.other.map(|(k, slip)| (count - 1 - k, back(slip))),
            state: State { theta: PI - theta, w1, w2: 0.0 - w2, w3: 0.0 - w3 },
            slip: back(self.slip),
            pose: [phi + PI, 0.0 - psi, x, y],
        }
    }

    /// The largest difference from a row of the table, over the size of each number if that is above 1; and the same
    /// for the pose, up to whole turns of phi.
    fn off(&self, row: &Self, circles: &[Circle]) -> [f64; 2] {
        let row = if self.other.is_some() { row.told_from_circle(self.circle, circles) } else { *row };
        assert_eq!((self.circle, self.other.map(|x| x.0)), (row.circle, row.other.map(|x| x.0)));
        let numbers = |told: &Self| {
            let State { theta, w1, w2, w3 } = told.state;
            let [u, v] = told.other.map_or([0.0; 2], |(_, slip)| slip);
            [theta, w1, w2, w3, told.slip[0], told.slip[1], u, v]
        };
        let most = |found: &[f64], known: &[f64]| {
            let each = found.iter().zip(known).map(|(a, b)| (a - b).abs() / b.abs().max(1.0));
            each.fold(0.0, |most: f64, x| if x <= most { most } else { x })
        };
        let turns = ((row.pose[0] - self.pose[0]) / TAU).round();
        let [phi, psi, x, y] = self.pose;
        [most(&numbers(self), &numbers(&row)), most(&[phi + turns * TAU, psi, x, y], &row.pose)]
    }
}

fn numbers(of: &Value) -> Vec<f64> {
    of.as_array().unwrap().iter().map(number).collect()
}

/// Converts a number of the reference table, where exact numbers have no quotes.
fn number(of: &Value) -> f64 {
    of.as_str().map_or_else(|| of.as_f64().unwrap(), |text| text.parse().unwrap())
}

fn table() -> Vec<Case> {
    let table: Value = from_str(include_str!("../reference/rims.json")).unwrap();
    let columns: Vec<&str> =
        table["columns"].as_array().unwrap().iter().map(|x| x.as_str().unwrap()).collect();
    assert_eq!(
        columns.join(" "),
        "kind t theta w1 w2 w3 u_h u_2 other_h other_2 heat work phi psi x y circle other"
    );
    table["motions"].as_array().unwrap().iter().map(case).collect()
}

fn case(of: &Value) -> Case {
    let circle = |x: &Value| {
        let [radius, depth, fillet] = numbers(x)[..] else { panic!("three numbers") };
        Circle { radius, depth, fillet }
    };
    let friction = if of["law"] == "viscous" {
        Friction::Viscous { c: number(&of["mu"]) }
    } else {
        Friction::Coulomb { mu: number(&of["mu"]), fixed: number(&of["static"]), patch: 0.0 }
    };
    let laws = [Law::DryContour, Law::ViscousContour, Law::RollingResistance, Law::Drilling];
    let laws = laws.into_iter().chain([Law::AirLinear, Law::AirQuadratic]);
    let losses = laws.zip(numbers(&of["losses"])).fold(Losses::NONE, |all, (law, x)| all.with(law, x));
    let told = |at: &[f64], [circle, other]: [f64; 2], slip, pose| Told {
        circle: circle as usize,
        other: (other >= 0.0).then_some((other as usize, slip)),
        state: State { theta: at[0], w1: at[1], w2: at[2], w3: at[3] },
        slip: [at[4], at[5]],
        pose,
    };
    let row = |row: &Value| {
        let all = row.as_array().unwrap();
        let at: Vec<f64> = all[1..].iter().map(number).collect();
        let [time, heat, work] = [at[0], at[9], at[10]];
        let told = told(&at[1..7], [at[15], at[16]], [at[7], at[8]], [at[11], at[12], at[13], at[14]]);
        Row { kind: all[0].as_str().unwrap().to_string(), time, told, heat, work }
    };
    let down = numbers(&of["down"]);
    let start = told(&numbers(&of["start"]), [down[0], down[1]], [0.0; 2], [0.0; 4]);
    let moments = numbers(&of["moments"]);
    Case {
        name: of["name"].as_str().unwrap().to_string(),
        circles: of["circles"].as_array().unwrap().iter().map(circle).collect(),
        moments: [moments[0], moments[1]],
        ask: Ask::on(friction).with_losses(losses).with_restitution(0.0).with_pose(),
        start,
        apex: of["apex"].as_f64(),
        rows: of["rows"].as_array().unwrap().iter().map(row).collect(),
    }
}

impl Case {
    /// The same motion with its states counted from the other end.
    fn turned(self) -> Self {
        let count = self.circles.len();
        let turn = |circle: Circle| Circle { depth: 0.0 - circle.depth, ..circle };
        let row = |row: Row| Row { told: row.told.told_from_other_end(count), ..row };
        Self {
            circles: self.circles.into_iter().rev().map(turn).collect(),
            start: Told { pose: [0.0; 4], ..self.start.told_from_other_end(count) },
            // Its motion starts with phi = 0, too, and the place of the circle is turned by pi with it.
            rows: self.rows.into_iter().map(row).map(Row::with_phi_from_zero).collect(),
            apex: self.apex.map(|rolling| 0.0 - rolling),
            ..self
        }
    }

    fn body(&self) -> Body {
        Body::profile(&self.circles, self.moments[0], self.moments[1]).unwrap()
    }

    /// The times of the outputs: those of the samples, and a time after the end of a motion that comes to rest.
    fn times(&self) -> Vec<f64> {
        let mut times: Vec<f64> = self.samples().map(|row| row.time).collect();
        if self.rows.last().unwrap().kind != "end" {
            times.push(self.rows.last().unwrap().time + 1.0);
        }
        times
    }

    fn samples(&self) -> impl Iterator<Item = &Row> {
        self.rows.iter().filter(|row| row.kind == "sample" || row.kind == "end")
    }

    fn rolled(&self) -> Motion {
        let body = self.body();
        let mut start = self.start;
        if start.other.is_some() {
            start.state.theta = body.theta_end();
            if let Some(rolling) = self.apex {
                let (s, c) = body.theta_end().sin_cos();
                (start.state.w1, start.state.w3) = (c * rolling, -s * rolling);
            }
            start = start.told_from_circle(self.lower(), &self.circles);
        }
        let start = Start::from(start.state).with_slip(start.slip.into());
        roll_with(&body, start, &self.times(), &self.ask, || true).unwrap().unwrap()
    }

    /// The distance of the first circle's contact point from that of the circle to which the initial state refers.
    fn first_at(&self) -> f64 {
        if self.start.other.is_some() {
            self.start.told_from_circle(self.lower(), &self.circles).pose[2]
        } else {
            0.0
        }
    }

    /// The lower one of the two circles on which the body lies.
    fn lower(&self) -> usize {
        let down =
            self.rows.iter().find_map(|row| row.told.other.map(|(other, _)| other.min(row.told.circle)));
        down.unwrap_or(0)
    }

    /// The outputs of the library at the index `i`.
    fn told(&self, m: &Motion, i: usize) -> Told {
        let (path, pose) = (m.path.as_ref().unwrap(), m.poses.as_ref().unwrap()[i]);
        let Slip { u_h: u, u_2: v, .. } = path.other_rim[i].slip;
        let at = pose.contact_point;
        let lies = !u.is_nan();
        Told {
            circle: if lies { self.lower() } else { path.rims[i].into() },
            other: lies.then_some((self.lower() + 1, [u, v])),
            state: m.states[i],
            slip: path.slip[i].into(),
            // The origin is where the first circle touches at the start, not the circle from which the start is told.
            pose: [pose.phi.radians(), pose.psi.radians(), at.x + self.first_at(), at.y],
        }
    }

    fn equal_rims(&self) -> bool {
        self.circles.windows(2).all(|of| of[0].radius == of[1].radius && of[0].fillet == of[1].fillet)
    }

    /// The rows of the table at which a phase begins, with the library's kind of phase. Of several changes at one
    /// time the last one counts.
    fn phases(&self) -> Vec<(&Row, Kind)> {
        let mut found: Vec<(&Row, Kind)> = Vec::new();
        for row in &self.rows {
            let kind = match row.kind.as_str() {
                "slides" | "lies" | "rocked" => Kind::Lying,
                "pivots" => Kind::Pivoting,
                "round" if self.equal_rims() => Kind::RollingOnItsSide,
                "round" => Kind::RollingRoundItsApex,
                "slips" | "passes" => Kind::Slipping,
                "rises" | "rocks" | "rolls" | "joint" if row.told.slip == [0.0; 2] => Kind::Rolling,
                "rises" | "rocks" | "rolls" | "joint" => Kind::Slipping,
                _ => continue,
            };
            found.pop_if(|last| last.0.time == row.time);
            found.push((row, kind));
        }
        let last = self.rows.last().unwrap();
        found.pop_if(|phase| last.kind == "rests" && phase.0.time == last.time);
        found
    }
}

impl Row {
    /// This row of a motion that starts with phi = pi, converted to a start with phi = 0.
    fn with_phi_from_zero(self) -> Self {
        let [phi, psi, x, y] = self.told.pose;
        Self { told: Told { pose: [phi - PI, psi, 0.0 - x, 0.0 - y], ..self.told }, ..self }
    }
}

/// Runs a check on all cases, with states counted from both ends of the body, or from both rims if these are equal.
fn each_case(mut check: impl FnMut(&Case, &Motion)) -> usize {
    let mut count = 0;
    let turned = table().into_iter().filter(|case| case.name != "cylinder falls and lies").map(Case::turned);
    for case in table().into_iter().chain(turned) {
        check(&case, &case.rolled());
        count += 1;
    }
    count
}

#[test]
fn states_slips_heat_and_poses_are_those_of_the_references() {
    let count = each_case(|case, m| {
        let path = m.path.as_ref().unwrap();
        assert_eq!(m.states.len(), case.samples().count(), "{}: {:?}", case.name, m.event);
        for (i, row) in case.samples().enumerate() {
            let [state, pose] = case.told(m, i).off(&row.told, &case.circles);
            let struck =
                path.impacts.iter().filter(|hit| hit.time <= row.time).map(|hit| hit.lost).sum::<f64>();
            let heat = (path.dissipated[i] + struck - row.heat).abs();
            let work = path.work_lost.get(i).map_or(0.0, |work| (work - row.work).abs());
            let spent = heat.max(work);
            assert!(
                state.max(spent) <= TIGHT.max(m.error),
                "{} {}: {state:e} {spent:e}",
                case.name,
                row.time
            );
            assert!(
                pose <= TIGHT.max(m.pose_error),
                "{} {}: {pose:e} {:e}",
                case.name,
                row.time,
                m.pose_error
            );
        }
    });
    assert!(count >= 39, "{count}");
}

#[test]
fn phases_begin_and_motions_end_where_those_of_the_references_do() {
    let (mut phases, mut rests) = (0, 0);
    each_case(|case, m| {
        let (true_ones, most) = (case.phases(), TIGHT.max(m.error));
        let all = &m.path.as_ref().unwrap().phases[1..];
        // Of infinitely many landings only the first ones have rows.
        let near = |row: &Row| {
            let apart = |i: &usize| (all[*i].time - row.time).abs();
            (0..all.len()).min_by(|i, j| apart(i).total_cmp(&apart(j))).unwrap()
        };
        let rocks = case.rows.iter().any(|row| row.kind == "rocked");
        assert!(rocks || all.len() == true_ones.len(), "{}: {all:?}", case.name);
        for (i, (row, kind)) in true_ones.iter().enumerate() {
            let phase = &all[if rocks { near(row) } else { i }];
            let late = (phase.time - row.time).abs();
            assert!(phase.kind == *kind && late <= most, "{} {} {late:e}: {phase:?}", case.name, row.kind);
            let lies = matches!(
                kind,
                Kind::Lying | Kind::Pivoting | Kind::RollingOnItsSide | Kind::RollingRoundItsApex
            );
            let lower = case.lower();
            let told = Told {
                circle: if lies { lower } else { phase.rim.into() },
                other: lies.then(|| row.told.told_from_circle(lower, &case.circles).other.unwrap()),
                state: phase.state,
                slip: phase.slip.into(),
                pose: row.told.pose,
            };
            let [off, _] = told.off(&row.told, &case.circles);
            assert!(off <= most, "{} {}: {off:e} {phase:?}", case.name, row.kind);
            phases += 1;
        }
        let last = case.rows.last().unwrap();
        if last.kind == "rests" {
            assert_eq!(m.ending(), Ending::Stops, "{}", case.name);
            let late = (m.event.unwrap().time - last.time).abs();
            assert!(late <= most, "{}: {late:e}", case.name);
            rests += 1;
        } else {
            assert_eq!(m.ending(), Ending::Done, "{}", case.name);
        }
    });
    assert!(phases >= 60 && rests >= 4, "{phases}, {rests}");
}
