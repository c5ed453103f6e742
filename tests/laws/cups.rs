//! Bodies that lie on two circles which are not equal, with known answers: cups and cones that roll round their apex, slide
//! along their side, pivot on one end and stop.

use crate::circles::frustum;
use crate::common::{drawn, larger, wander};
use spincyl::body::Circle;
use spincyl::contact::slip::Friction;
use spincyl::loss::{Law, Losses};
use spincyl::motion::path::Kind;
use spincyl::motion::{AboveTable, Ask, Ending, Motion, Start, roll_with};
use spincyl::{Body, Slip, State};
use std::f64::consts::{PI, TAU};

/// A body that lies on two circles, and the dimensions of both at that inclination.
struct OnTwo {
    body: Body,
    s: f64,
    c: f64,
    /// Height of the centre of mass; the next field has radius, depth and lever of each circle.
    height: f64,
    touching: [[f64; 3]; 2],
    /// The moment of inertia about the line through both contact points.
    inertia: f64,
}

impl OnTwo {
    fn of(body: Body) -> Self {
        let (s, c) = body.theta_end().sin_cos();
        let circles = body.circles();
        let at = |k: usize| {
            let Circle { radius, depth, fillet } = circles[k];
            [radius + fillet * s, depth + fillet * c, depth * s - radius * c]
        };
        let height = circles[0].depth * c + circles[0].radius * s + circles[0].fillet;
        let inertia = body.i1() * c * c + body.i3() * s * s + height * height;
        Self { body, s, c, height, touching: [at(0), at(1)], inertia }
    }

    fn levers(&self) -> [f64; 2] {
        self.touching.map(|at| at[2])
    }

    fn span(&self) -> f64 {
        self.touching[0][2] - self.touching[1][2]
    }

    /// A start with these w_z and w_h, and with a slip of the first circle.
    fn start(&self, [drilling, rolling]: [f64; 2], slip: [f64; 2]) -> Start {
        let (s, c) = (self.s, self.c);
        let (w1, w3) = (s * drilling + c * rolling, c * drilling - s * rolling);
        Start::from(State { theta: self.body.theta_end(), w1, w2: 0.0, w3 }).with_slip(slip.into())
    }

    /// The start with these w_z and w_h, and with this velocity of the centre along the lean and across it.
    fn thrown(&self, [drilling, rolling]: [f64; 2], [along, across]: [f64; 2]) -> Start {
        let [radius, depth, _] = self.touching[0];
        let State { w1, w3, .. } = self.start([drilling, rolling], [0.0; 2]).state;
        self.start([drilling, rolling], [along, across + depth * w1 - radius * w3])
    }

    /// The rates w_z and w_h of a state.
    fn turning(&self, y: &State) -> [f64; 2] {
        [self.s * y.w1 + self.c * y.w3, self.c * y.w1 - self.s * y.w3]
    }

    fn moves(&self, start: Start, ask: &Ask, times: &[f64]) -> Motion {
        roll_with(&self.body, start, times, ask, || true).unwrap().unwrap()
    }
}

fn ask(mu: f64) -> Ask {
    Ask::on(Friction::coulomb(mu)).with_restitution(0.0).with_pose().with_force()
}

fn kinds(m: &Motion) -> Vec<Kind> {
    m.path.as_ref().unwrap().phases.iter().map(|phase| phase.kind).collect()
}

/// Two balls of these radii, the larger one first, that touch each other.
pub fn balls(radii: [f64; 2]) -> Body {
    let [big, small] = radii.map(|r: f64| r * r * r);
    let (far, mass) = (radii[0] + radii[1], big + small);
    let depths = [far * small / mass, -far * big / mass];
    let shared = [0, 1].map(|k| [big, small][k] / mass);
    let i3: f64 = (0..2).map(|k| 0.4 * shared[k] * radii[k] * radii[k]).sum();
    let i1 = i3 + (0..2).map(|k| shared[k] * depths[k] * depths[k]).sum::<f64>();
    let circle = |k: usize| Circle { radius: 0.0, depth: depths[k], fillet: radii[k] };
    Body::profile(&[circle(0), circle(1)], i1, i3).unwrap()
}

/// A random body that lies on two circles: a cup either way up, a cone, a frustum with rounded rims, or unequal
/// balls.
fn any(next: &mut impl FnMut() -> f64) -> OnTwo {
    let (r, height) = (0.3 + 0.6 * next(), 0.4 + 2.0 * next());
    OnTwo::of(match (5.0 * next()) as usize {
        0 => frustum([r, 1.0], height),
        1 => frustum([1.0, r], height),
        2 => frustum([0.0, 1.0], height),
        3 => balls([1.0, r]),
        _ => {
            let fillets = [0.3 * next(), 0.3 * next()];
            let circle = |radius: f64, depth, fillet| Circle { radius: radius - fillet, depth, fillet };
            let low = height * (0.3 + 0.4 * next());
            let circles = [circle(r, low, fillets[0]), circle(1.0, low - height, fillets[1])];
            let i3 = 0.3 + 0.4 * next();
            Body::profile(&circles, 0.6 * i3 + height * height / 12.0, i3).unwrap()
        }
    })
}

/// The same body counted from its other end.
fn turned(body: &Body) -> Body {
    let turn = |circle: Circle| Circle { depth: 0.0 - circle.depth, ..circle };
    let circles: Vec<Circle> = body.circles().into_iter().rev().map(turn).collect();
    Body::profile(&circles, body.i1(), body.i3()).unwrap()
}

#[test]
fn a_cone_rolls_on_its_side_about_its_tip_with_the_energy_of_the_textbook() {
    for (height, mu) in [(2.0, 0.9), (1.0, 2.0), (0.5, 3.0)] {
        let cone = OnTwo::of(frustum([0.0, 1.0], height));
        let half = f64::atan(1.0 / height);
        let [_, levers] = cone.levers();
        let fast = (levers.abs() * cone.c / (cone.inertia * cone.s)).sqrt();
        let rate = 0.9 * fast;
        let rolling = rate * cone.s / cone.c;
        let round = TAU / rate;
        let times: Vec<f64> = (0..=8).map(|k| round * f64::from(k) / 8.0).collect();
        let m = cone.moves(cone.start([0.0, rolling], [0.0; 2]), &ask(mu), &times);
        assert_eq!(kinds(&m), [Kind::RollingRoundItsApex]);
        // Landau and Lifshitz, Mechanics, section 32.
        let told = 3.0 / 40.0 * (height * rate).powi(2) * (1.0 + 5.0 * half.cos().powi(2));
        assert!((cone.inertia * rolling * rolling / 2.0 - told).abs() < 1e-14 * told);
        let poses = m.poses.as_ref().unwrap();
        for (pose, t) in poses.iter().zip(&times) {
            assert!(pose.contact_point.coords.norm() < 1e-14, "the tip stays");
            assert!((pose.phi.radians() - rate * t).abs() < 1e-13);
        }
        // In a round the body turns about its axis by the slant height over the radius.
        let turns = poses[8].psi.radians() / TAU;
        assert!((turns + 1.0 / half.sin()).abs() < 1e-13 * turns.abs());
    }
}

#[test]
fn the_narrow_end_of_what_rolls_round_its_apex_rises_above_a_rate_and_its_friction_slides_it_outward_below_a_coefficient()
 {
    for body in
        [frustum([0.7, 1.0], 2.0), frustum([1.0, 0.7], 2.0), frustum([0.9, 1.0], 0.5), balls([1.0, 0.8])]
    {
        let cup = OnTwo::of(body);
        let narrow = usize::from(cup.c < 0.0);
        let wide = cup.levers()[1 - narrow].abs();
        let apart = (cup.s / cup.c).abs();
        let rises = (wide / (cup.inertia * apart)).sqrt();
        let rolled = |share: f64, mu: f64| {
            let rolling = share * rises * apart;
            let m = cup.moves(cup.start([0.0, rolling], [0.0; 2]), &ask(mu), &[0.1]);
            assert_eq!(m.states.len(), 1, "{:?} {:?} {:?}", m.event, m.path, cup.body);
            m
        };
        let near = 1e-6;
        let holds = cup.height * wide / cup.inertia;
        let m = rolled(1.0 - near, 1.1 * holds);
        assert_eq!(kinds(&m), [Kind::RollingRoundItsApex]);
        assert!(m.path.as_ref().unwrap().other_rim[0].slip.u_h == 0.0);
        let m = rolled(1.0 + near, 1.1 * holds);
        assert_eq!(kinds(&m), [Kind::Rolling], "{:?}", m.event);
        assert_eq!(m.path.as_ref().unwrap().rims[0], 1 - narrow as u8, "the wide end carries it");
        // At a lower rate the friction that it needs falls with the square of the rate.
        let m = rolled(0.5, 0.25 * holds * (1.0 + near));
        assert_eq!(kinds(&m), [Kind::RollingRoundItsApex]);
        let m = rolled(0.5, 0.25 * holds * (1.0 - 1e-3));
        assert_eq!(kinds(&m)[0], Kind::Lying);
        let Slip { u_h: along, .. } = m.path.as_ref().unwrap().slip[0];
        assert!(along * cup.c < 0.0, "away from the apex: {along}");
    }
}

#[test]
fn what_slides_along_its_side_stops_as_a_block_does_unless_it_tips_over_its_leading_end() {
    let mut next = wander(11);
    let (mut stops, mut tips) = (0, 0);
    for _ in 0..drawn(60) {
        let cup = any(&mut next);
        let [here, there] = cup.levers();
        let speed = 1.0 + next();
        for (way, leads) in [(1.0, here), (-1.0, -there)] {
            let tipping = leads / cup.height;
            // Both ends press, and neither is jammed.
            let jams = (cup.body.i1() + leads * leads) / (leads.abs() * cup.height);
            let rests = here > 0.0 && there < 0.0;
            if !rests || tipping < 0.05 || 1.001 * tipping > 0.99 * jams {
                continue;
            }
            let start = cup.thrown([0.0; 2], [way * speed, 0.0]);
            let mu = 0.999 * tipping;
            let (stop, far) = (speed / mu, 0.5 * speed * speed / mu);
            let m = cup.moves(start, &ask(mu), &[0.5 * stop, stop + 1.0]);
            let path = m.path.as_ref().unwrap();
            assert_eq!(kinds(&m), [Kind::Lying, Kind::RollingRoundItsApex]);
            assert!((path.phases[1].time - stop).abs() < 1e-12 * stop);
            assert!((path.heat - 0.5 * speed * speed).abs() < 1e-12 * speed * speed);
            let ways = [0.75 * far, far].map(|x| way * x);
            for (pose, x) in m.poses.as_ref().unwrap().iter().zip(ways) {
                assert!((pose.contact_point.x - x).abs() < 1e-12 * far && pose.contact_point.y == 0.0);
            }
            let known = (mu * cup.height * way - there) / cup.span();
            assert!((m.forces.as_ref().unwrap()[0].normal - known).abs() < 1e-13);
            stops += 1;
            let m = cup.moves(start, &ask(1.001 * tipping), &[0.01]);
            assert_eq!(kinds(&m), [Kind::Slipping]);
            assert_eq!(m.path.as_ref().unwrap().rims[0], u8::from(way < 0.0), "on its leading end");
            tips += 1;
        }
    }
    assert!(stops == tips && stops > 10, "{stops}");
}

#[test]
fn a_body_that_pivots_on_one_end_loses_its_turn_to_the_friction_of_the_other_end() {
    let mut next = wander(12);
    let mut pivots = 0;
    for _ in 0..drawn(120) {
        let (cup, mu) = (any(&mut next), 0.1 + 0.5 * next());
        let (turn, rolling) = (0.4 * next() - 0.2, 0.4 * next() - 0.2);
        let step = 1e-3;
        let m = cup.moves(cup.start([turn, rolling], [0.0; 2]), &ask(mu), &[0.0, step, 2.0 * step]);
        if kinds(&m) != [Kind::Pivoting] {
            continue;
        }
        let State { w1, w3, .. } = m.states[0];
        let (i1, i3, [radius, depth, lever]) = (cup.body.i1(), cup.body.i3(), cup.touching[0]);
        let along = -(w1 / cup.s) * (radius * w3 - depth * w1);
        let lift = i3 * w1 * w3 - i1 * cup.c / cup.s * w1 * w1;
        let load = (lever - lift + cup.height * along) / cup.span();
        let per = 1.0 + depth * depth / i1 + radius * radius / i3;
        let slows = -turn.signum() * mu * load * cup.span() * cup.inertia / (per * i1 * i3);
        let [a, b, c] = [0, 1, 2].map(|i| cup.turning(&m.states[i])[0]);
        let found = (4.0 * b - 3.0 * a - c) / (2.0 * step);
        assert!((found - slows).abs() < 1e-5 * (1.0 + slows.abs()), "{found} {slows}");
        assert!((m.path.as_ref().unwrap().other_rim[0].force.normal - load).abs() < 1e-13);
        pivots += 1;
    }
    assert!(pivots > 10, "{pivots}");
}

#[test]
fn what_rolls_round_its_apex_slows_and_rests_as_its_losses_say() {
    let mut next = wander(13);
    for _ in 0..drawn(30) {
        let cup = any(&mut next);
        let rolling = (0.2 + 0.3 * next()) * if next() < 0.5 { 1.0 } else { -1.0 };
        let (delta, air) = (0.01 + 0.05 * next(), 0.01 + 0.1 * next());
        let (start, friction, speed) = (cup.start([0.0, rolling], [0.0; 2]), ask(10.0), rolling.abs());
        if kinds(&cup.moves(start, &friction, &[1.0])) != [Kind::RollingRoundItsApex] {
            continue;
        }
        let inertia = cup.inertia;
        let dry = Losses::of(Law::RollingResistance, delta);
        for (losses, rests) in [
            (dry, inertia * speed / delta),
            (dry.with(Law::AirLinear, air), inertia / air * (air * speed / delta).ln_1p()),
        ] {
            let m = cup.moves(start, &friction.with_losses(losses), &[0.5 * rests, 2.0 * rests]);
            assert_eq!((m.states.len(), m.ending()), (1, Ending::Stops));
            let end = m.event.unwrap();
            let late = end.time - rests;
            assert!(late.abs() <= 1e-11_f64.max(m.error), "{late:e} {:e}", m.error);
            assert!(end.state.w1 == 0.0 && end.state.w3 == 0.0, "{end:?} {losses:?}");
        }
        let left = |losses| {
            let m = cup.moves(start, &friction.with_losses(losses), &[3.0]);
            cup.turning(&m.states[0])[1].abs()
        };
        let fades = speed * (-3.0 * air / inertia).exp();
        assert!((left(Losses::of(Law::AirLinear, air)) - fades).abs() < 1e-12);
        let slows = 1.0 / (1.0 / speed + 3.0 * air / inertia);
        assert!((left(Losses::of(Law::AirQuadratic, air)) - slows).abs() < 1e-12);
    }
}

#[test]
fn a_body_that_lies_makes_the_same_motion_told_from_either_end() {
    let mut next = wander(14);
    let mut seen = [0; 7];
    for _ in 0..drawn(180) {
        let cup = any(&mut next);
        let (there, mut number) = (OnTwo::of(turned(&cup.body)), || 2.0 * next() - 1.0);
        let (turning, slip, mu) = ([number(), number()], [number(), number()], 0.55 + 0.4 * number());
        let start = cup.start(turning, slip);
        let [drilling, rolling] = turning;
        // The other circle slips as the body turns about the vertical.
        let other = [-slip[0], cup.span() * drilling - slip[1]];
        let told = there.start([drilling, -rolling], other);
        let times = [0.5, 1.0, 2.0, 4.0];
        let [m, n] = [cup.moves(start, &ask(mu), &times), there.moves(told, &ask(mu), &times)];
        assert_eq!(
            (kinds(&m), m.ending()),
            (kinds(&n), n.ending()),
            "{:?} {:?} {start:?} {mu} {:?}",
            cup.body,
            m.path.as_ref().unwrap().phases,
            m.event
        );
        kinds(&m).iter().for_each(|kind| seen[*kind as usize] += 1);
        let most = 1e-11_f64.max(4.0 * (m.error + n.error));
        for (a, b) in m.states.iter().zip(&n.states) {
            let off = [a.theta + b.theta - PI, a.w1 - b.w1, a.w2 + b.w2, a.w3 + b.w3];
            assert!(off.into_iter().all(|x| x.abs() <= most), "{off:?} {most:e} {:?}", cup.body);
        }
        for (a, b) in m.path.as_ref().unwrap().phases.iter().zip(&n.path.as_ref().unwrap().phases) {
            assert!((a.time - b.time).abs() <= most, "{a:?} {b:?} {most:e}");
        }
    }
    assert!(seen.into_iter().filter(|count| *count > 0).count() >= 5, "{seen:?}");
}

#[test]
fn a_cup_that_is_all_but_a_cylinder_moves_as_the_cylinder_does() {
    let mut next = wander(15);
    let cylinder = OnTwo::of(frustum([1.0; 2], 1.0));
    for _ in 0..drawn(36) {
        let mut number = || 2.0 * next() - 1.0;
        let (turning, velocity) = ([number(), number()], [number(), number()]);
        let falls = State { theta: 1.5 + 0.05 * number(), w1: 0.5 * number(), w2: 0.0, w3: 0.5 * number() };
        for e in [0.0, 0.4] {
            let moved = |cup: &OnTwo, lies: bool| {
                let start = if lies { cup.thrown(turning, velocity) } else { Start::from(falls) };
                cup.moves(start, &ask(0.3).with_restitution(e), &[0.3, 1.0])
            };
            for lies in [false, true] {
                let known = moved(&cylinder, lies);
                let off = |share: f64| {
                    let m = moved(&OnTwo::of(frustum([1.0 - share, 1.0], 1.0)), lies);
                    assert_eq!(m.ending(), known.ending());
                    let pairs = m.states.iter().zip(&known.states);
                    let apart = |a: &State, b: &State| {
                        let off = [a.theta - b.theta, a.w1 - b.w1, a.w2 - b.w2, a.w3 - b.w3];
                        off.into_iter().fold(0.0, |most: f64, x| most.max(x.abs()))
                    };
                    (pairs.map(|(a, b)| apart(a, b)).fold(0.0, larger), m.error)
                };
                let [(far, _), (near, error)] = [off(1e-5), off(1e-8)];
                // Impacts amplify a difference.
                assert!(
                    far < 1e-2 && near < 2e-3 * far + 1e-11_f64.max(10.0 * error),
                    "{far:e} {near:e} {error:e}"
                );
            }
        }
    }
}

#[test]
fn a_body_whose_centre_is_not_between_its_contacts_leaves_the_table_with_both_where_it_turns_fast() {
    let mut next = wander(16);
    let (mut flies, mut stays) = (0, 0);
    for _ in 0..drawn(300) {
        let cup = OnTwo::of(frustum([0.3 + 0.5 * next(), 1.0], 0.2 + 0.2 * next()));
        let ([here, there], mut number) = (cup.levers(), || 2.0 * next() - 1.0);
        if here * there < 0.0 {
            continue;
        }
        let start = cup.start([4.0 * number(), 4.0 * number()], [number(), number()]);
        let State { w1, w3, .. } = start.state;
        let (i1, i3) = (cup.body.i1(), cup.body.i3());
        let rate = (i3 * w1 * w3 - i1 * cup.c / cup.s * w1 * w1) / i1;
        let free = [here, there].map(|lever| -1.0 - lever * rate);
        if free.iter().any(|rise| rise.abs() < 0.1) {
            continue;
        }
        let m = cup.moves(start, &ask(0.3), &[0.01]);
        let path = m.path.as_ref().unwrap();
        if free.iter().all(|rise| *rise > 0.0) {
            assert_eq!(kinds(&m), [Kind::Flying], "{:?} {start:?}", cup.body);
            let AboveTable { height, .. } = path.aloft[0];
            // Each circle rises as its free acceleration says.
            let known = 0.5 * 1e-4 * free[usize::from(path.rims[0])];
            assert!((height - known).abs() < 0.05 * known, "{height} {known}");
            flies += 1;
        } else {
            assert_ne!(kinds(&m)[0], Kind::Flying);
            stays += 1;
        }
    }
    assert!(flies > 10 && stays > 10, "{flies} {stays}");
}

#[test]
fn dry_friction_along_the_contour_keeps_a_body_that_slides_across_from_rolling_by_the_loads_of_both_circles()
{
    let mut next = wander(17);
    let mut held = 0;
    for _ in 0..drawn(60) {
        let (cup, mu, speed) = (any(&mut next), 0.1 + 0.2 * next(), 0.5 + next());
        let ([here, there], [low, up]) = (cup.levers(), cup.touching.map(|at| at[0]));
        if here < 0.0 || there > 0.0 {
            continue;
        }
        // Friction turns the body by its height, and each contour holds it by its radius and its load.
        let holds = (here * up - there * low) / (cup.span() * cup.s);
        let moved = |share: f64| {
            let losses = Losses::of(Law::DryContour, share * mu * cup.height / holds);
            cup.moves(cup.thrown([0.0; 2], [0.0, speed]), &ask(mu).with_losses(losses), &[0.5 * speed / mu])
        };
        let m = moved(1.001);
        assert!(m.states[0].w1.abs().max(m.states[0].w3.abs()) < 1e-15, "{:?} {:?}", m.states[0], cup.body);
        let path = m.path.as_ref().unwrap();
        assert!((path.slip[0].u_2 - 0.5 * speed).abs() < 1e-13 && path.slip[0].u_h.abs() < 1e-15);
        assert!(cup.turning(&moved(0.999).states[0])[1].abs() > 1e-5, "{:?}", cup.body);
        held += 1;
    }
    assert!(held > 5, "{held}");
}
