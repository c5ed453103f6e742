//! A body that lies on two circles: its forces and accelerations while they slip or stick.
//!
//! ```text
//! theta = theta_k, w2 = 0;   circle i touches at g_i e_h - Z z from the centre: g its lever, A its radius, L its depth
//! Om = w1/s,  w_z = s w1 + c w3,  w_h = c w1 - s w3,  K = I3 w1 w3 - I1 cot w1^2,  D = g - g',  n = (s, c) or (c, -s)
//! v_h = u_h,  v_2 = u_2 - L w1 + A w3;   u' = (u_h, u_2 - D w_z) at the other circle
//! N + N' = 1,   g N + g' N' = K - Z F_h + m2,   F_h, F_2 the friction of both
//! I1 w1' = sum L F_2 + m1,   I3 w3' = -sum A F_2 + m3,   v_h' = F_h + Om v_2,   v_2' = F_2 - Om v_h
//! both slip      F = -N d,  d = mu u/|u| or c u:   N = (K + q)/(p + q),   p = g - Z d_h,  q = Z d_h' - g'
//! one sticks     v_h = 0,  F_h = -Om v_2 at that circle alone;  F_2 from u_2' = 0
//! both stick     w_z = 0:  w = w_h h,  (I1 c^2 + I3 s^2 + Z^2) w_h' = m.h,  F_h = cot Z w_h^2 in all: round the apex
//! a slope pulls with G_h and G_2: v' also has G;  F_h = -Om v_2 - G_h of one that sticks;  m.h - Z G_2 and F_h - G_h of both
//! dry losses hold w_z or w_h: then n.(w1', w3') = 0, which takes n from the mobility M = diag(1/I1, 1/I3)
//! ```
//! For two equal rims theta = pi/2, L = -L' = g = ell, A = Z = 1, and a rolling body moves along a straight line. A
//! fillet enters by A and L alone. The couple of the losses is shared between the circles as the normal forces are. A
//! line of contact has an undetermined pressure; the model is that of a body whose side is slightly hollow, or of a
//! rounded rim. While both circles stick, their shares of F_h are not determined, and both shares are set to zero. For
//! mu Z < D one distribution of the normal forces exists for any velocities (a linear complementarity problem with
//! positive diagonal).
//!
//! Error: a few roundings of the terms written above; tests of `laws` compare with Newton's equations.

use super::slip::Friction;
use crate::laws::body::{Body, Border, CircleDown, Shape};
use crate::laws::loss::{Couples, Holds, Kinematics, Losses};
use crate::laws::state::{drilling_of, rolling_of};
use crate::numbers::Real;

/// A body that lies on two circles, on a table with friction.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Lying<T> {
    /// The shape of the body, with the circle to which the state refers.
    pub shape: Shape<T>,
    /// Both circles at the inclination at which both touch, that of the state first.
    pub border: Border<T>,
    /// The coefficient of friction mu, or c of a film, at the circle of the state and at the other one.
    pub strength: [T; 2],
    pub dry: bool,
    pub losses: Option<Couples<T>>,
    /// The couple of a user-defined law in the present state; None without such a law.
    pub own: Option<[T; 3]>,
    /// The horizontal acceleration by the slope of a tilted table, along e_h and e2; None on a level table.
    pub pull: Option<[T; 2]>,
}

/// Forces on both circles, and accelerations of the body.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Lain<T> {
    /// [N, F_2, F_h] at the circle to which the state refers, and at the other one.
    pub force: [[T; 3]; 2],
    /// The derivatives w1' and w3'.
    pub w: [T; 2],
    /// The derivatives u_h' and u_2' of the slip.
    pub u: [T; 2],
    /// The couples of the losses about the vertical z, and along -e_h.
    pub couple: [T; 2],
}

/// The numbers of a body on two circles: w1, w3, u_h and u_2.
pub(crate) type Flat<T> = [T; 4];

impl Lying<f64> {
    /// The drilling w_z and -w_h, from w1 and w3; a result that is only a rounding error is zero.
    pub fn turning(&self, w1: f64, w3: f64) -> [f64; 2] {
        let (s, c) = self.border.angle;
        let [drilling, rolling] = [drilling_of((s, c), w1, w3), -rolling_of((s, c), w1, w3)];
        let zero =
            |x: f64, a: f64, b: f64| if x.abs() <= 4.0 * f64::EPSILON * (a * b).abs() { 0.0 } else { x };
        // Both terms have the same size where they cancel; at a right angle there is only one.
        [zero(drilling, w3, c), zero(rolling, w1, c)]
    }

    /// w1 and w3, from the drilling w_z and from -w_h.
    pub fn turned_by(&self, [drilling, rolling]: [f64; 2]) -> [f64; 2] {
        let (s, c) = self.border.angle;
        [s * drilling - c * rolling, c * drilling + s * rolling]
    }

    pub fn on(body: &Body, friction: &Friction, losses: &Losses) -> Self {
        let dry = matches!(*friction, Friction::Coulomb { mu, .. } if mu > 0.0 || friction.sticks());
        Self {
            shape: body.shape(),
            border: body.border(),
            strength: [friction.strength(); 2],
            dry,
            losses: Couples::some(losses),
            own: None,
            pull: None,
        }
    }

    /// The largest couples with which dry losses can hold w_z and w_h at rest, under the normal forces `loads`.
    pub fn limits(&self, loads: [f64; 2]) -> [f64; 2] {
        // At this speed all couples that are not dry are nearly zero.
        const SLOW: f64 = 1e-100;
        const NOTHING: f64 = 1e-80;
        let (s, c) = self.border.angle;
        let couple = Self { own: None, ..*self }.couple([SLOW * (s - c), SLOW * (c + s)], loads);
        self.parts(couple).map(|x| if x.abs() > NOTHING { x.abs() } else { 0.0 })
    }
}

impl<T: Real> Lying<T> {
    /// Converts the laws to another type of number.
    pub fn map<U: Real>(&self, number: impl Fn(T) -> U) -> Lying<U> {
        Lying {
            shape: self.shape.map(&number),
            border: self.border.map(&number),
            strength: self.strength.map(&number),
            dry: self.dry,
            losses: self.losses.as_ref().map(|losses| losses.map(&number)),
            own: self.own.map(|m| m.map(&number)),
            pull: self.pull.map(|pull| pull.map(&number)),
        }
    }

    /// Whether both circles would rise if the table exerted no force, as may happen where the centre is not between them.
    pub fn takes_off(&self, w1: T, w3: T) -> bool {
        let (one, rate) = (w1.splat(1.0), self.lift(w1, w3) / self.shape.i1);
        self.border.circles.iter().all(|at| one.is_lt(w1.splat(0.0) - at.lever * rate))
    }

    /// The slip of the circle to which the state does not refer, along e_h and e2.
    pub fn other_slip(&self, [w1, w3, u_h, u_2]: Flat<T>) -> [T; 2] {
        [u_h, u_2 - self.border.span() * drilling_of(self.border.angle, w1, w3)]
    }

    /// The friction per normal force, with its sign reversed, at a circle of this strength that slips with `u`.
    pub fn drag(&self, strength: T, u: [T; 2]) -> [T; 2] {
        let size = if self.dry { u[0].mac(u[0], u[1] * u[1]).sqrt() } else { u[0].splat(1.0) };
        u.map(|u| strength * u / size)
    }

    /// The components about the vertical, and along -e_h, of a couple with m1 and m3.
    fn parts(&self, [m1, _, m3]: [T; 3]) -> [T; 2] {
        [drilling_of(self.border.angle, m1, m3), -rolling_of(self.border.angle, m1, m3)]
    }

    /// K = I3 w1 w3 - I1 cot w1^2, plus the couple of a user-defined law about e2.
    pub(super) fn lift(&self, w1: T, w3: T) -> T {
        let (s, c) = self.border.angle;
        let lift = self.shape.i3 * w1 * w3 - self.shape.i1 * (c / s) * w1 * w1;
        self.own.map_or(lift, |[_, m2, _]| lift + m2)
    }

    /// Whether dry losses hold w_z, the drilling, and w_h, the rolling, at rest.
    pub fn held(&self) -> [bool; 2] {
        let Holds { contour, drilling, .. } = self.losses.as_ref().map_or(Holds::default(), Couples::holds);
        [drilling, contour]
    }

    /// The couples m1, m2 and m3 of the losses, under the normal forces `loads`. Only a user-defined law may have m2,
    /// which then takes no power.
    pub(super) fn couple(&self, w: [T; 2], loads: [T; 2]) -> [T; 3] {
        let [m1, m3] = self.couple_of_losses(w, loads);
        match self.own {
            Some([o1, o2, o3]) => [m1 + o1, o2, m3 + o3],
            None => [m1, m1.splat(0.0), m3],
        }
    }

    /// m1 and m3 of the losses: each circle has its share of the weight times the couple under the whole weight.
    fn couple_of_losses(&self, [w1, w3]: [T; 2], loads: [T; 2]) -> [T; 2] {
        let zero = w1.splat(0.0);
        let Some(losses) = &self.losses else { return [zero; 2] };
        let (one, angle, [here, there]) = (w1.splat(1.0), self.border.angle, self.border.circles);
        let mut seen = Kinematics::of(&self.shape.rim, angle, w1 / angle.0, [w1, zero, w3]);
        if let Some(ways) = &losses.ways {
            // The body can only roll along both circles.
            (seen.signs, seen.only) = ([ways.contour, ways.drilling], Some([zero - ways.contour, zero]));
        }
        let under = |radius: T| losses.at(&Kinematics { radius, ..seen }).under(one);
        let [m1, _, m3] = under(here.radius);
        if self.border.even {
            return [m1, m3];
        }
        let [other, _, last] = under(there.radius);
        [loads[0] * m1 + loads[1] * other, loads[0] * m3 + loads[1] * last]
    }

    /// The derivatives w1' and w3' under these torques about e1 and e3, where dry losses may hold w_z, or w_h, or both, at rest.
    fn turned(&self, [t1, t3]: [T; 2]) -> [T; 2] {
        let (Shape { i1, i3, .. }, (s, c)) = (self.shape, self.border.angle);
        match self.held() {
            [false, false] => [t1 / i1, t3 / i3],
            [true, false] => {
                let d = rolling_of((s, c), t1, t3) / (i1 * c * c + i3 * s * s);
                [c * d, -(s * d)]
            }
            [false, true] => {
                let d = drilling_of((s, c), t1, t3) / (i1 * s * s + i3 * c * c);
                [s * d, c * d]
            }
            [true, true] => [t1.splat(0.0); 2],
        }
    }

    /// The torque about e1 and e3 of the friction F_2 at both circles.
    fn torque(&self, across: [T; 2]) -> [T; 2] {
        let [here, there] = self.border.circles;
        let ([low, up], zero) = (across, across[0].splat(0.0));
        [here.depth * low + there.depth * up, zero - (here.radius * low + there.radius * up)]
    }

    /// Forces and accelerations for these normal forces, this friction and this couple.
    pub(super) fn under(
        &self,
        [w1, w3, u_h, u_2]: Flat<T>,
        force: [[T; 3]; 2],
        [m1, _, m3]: [T; 3],
    ) -> Lain<T> {
        let (Shape { i1, i3, .. }, (s, _), [here, _]) = (self.shape, self.border.angle, self.border.circles);
        let [[_, low, low_h], [_, up, up_h]] = force;
        let [t1, t3] = self.torque([low, up]);
        let w @ [d1, d3] = self.turned([t1 + m1, t3 + m3]);
        let mut couple = [m1, m1, m3];
        if self.held() != [false; 2] {
            couple = [i1 * d1 - t1, m1, i3 * d3 - t3];
        }
        let (turns, aside) = (w1 / s, u_2 - here.depth * w1 + here.radius * w3);
        let across = low + up - turns * u_h + here.depth * d1 - here.radius * d3;
        let mut u = [low_h + up_h + turns * aside, across];
        if let Some([pull_h, pull_2]) = self.pull {
            u = [u[0] + pull_h, u[1] + pull_2];
        }
        Lain { force, w, u, couple: self.parts(couple) }
    }

    /// Forces and accelerations where both circles slip, for friction per normal force (sign reversed) at each circle.
    pub fn slipping_along(&self, y: Flat<T>, [low, up]: [[T; 2]; 2]) -> Lain<T> {
        let [w1, w3, ..] = y;
        let (zero, lift, [p, q]) = (w1.splat(0.0), self.lift(w1, w3), self.leans([low[0], up[0]]));
        let loads @ [n, m] = [(lift + q) / (p + q), (p - lift) / (p + q)];
        let force = [(n, low), (m, up)].map(|(n, d)| [n, zero - n * d[1], zero - n * d[0]]);
        self.under(y, force, self.couple([w1, w3], loads))
    }

    /// p and q of the equations above, for friction along e_h per normal force (sign reversed): the body lies where -q < K < p.
    pub fn leans(&self, [low, up]: [T; 2]) -> [T; 2] {
        let (height, [here, there]) = (self.border.height, self.border.circles);
        [here.lever - height * low, height * up - there.lever]
    }

    /// Forces and accelerations where both circles slip.
    pub fn slipping(&self, y: Flat<T>) -> Lain<T> {
        let [low, up] = self.strength;
        let drags = [self.drag(low, [y[2], y[3]]), self.drag(up, self.other_slip(y))];
        self.slipping_along(y, drags)
    }

    /// The change of the slip along e2 at circle `at` per force along e2 at circle `by`.
    pub fn yields(&self, at: usize, by: usize) -> T {
        let [at, by] = [self.border.circles[at], self.border.circles[by]];
        let one = at.radius.splat(1.0);
        one + at.depth * by.depth / self.shape.i1 + at.radius * by.radius / self.shape.i3
    }

    /// The slip if the circle to which the state refers sticks, or if `other` the other circle.
    pub fn stuck(&self, [w1, w3, ..]: Flat<T>, other: bool) -> [T; 2] {
        let zero = w1.splat(0.0);
        [zero, if other { self.border.span() * drilling_of(self.border.angle, w1, w3) } else { zero }]
    }

    /// Forces and accelerations where one circle sticks, the other one if `other`, and its partner slips along e2;
    /// `turn` is the sign of w_z.
    pub fn pivots(&self, y: Flat<T>, other: bool, turn: f64) -> Lain<T> {
        let [w1, w3, ..] = y;
        let (zero, one, Border { angle, height, circles, .. }) = (w1.splat(0.0), w1.splat(1.0), self.border);
        let (sticks, slips) = if other { (1, 0) } else { (0, 1) };
        let (at, far) = (circles[sticks], circles[slips]);
        let mut along = w1 / angle.0 * (at.depth * w1 - at.radius * w3);
        if let Some([pull_h, _]) = self.pull {
            along = along - pull_h;
        }
        let (push, span) = (self.lift(w1, w3) - height * along, at.lever - far.lever);
        let mut loads = [zero; 2];
        loads[sticks] = (push - far.lever) / span;
        loads[slips] = (at.lever - push) / span;
        let couple @ [m1, _, m3] = self.couple([w1, w3], loads);
        let way = if other { -turn } else { turn };
        let across = self.strength[slips] * loads[slips] * one.splat(way);
        let along_arm = |[d1, d3]: [T; 2]| at.depth * d1 - at.radius * d3;
        let arm = |of: CircleDown<T>| self.turned([of.depth, zero - of.radius]);
        let mut free = (one + along_arm(arm(far))) * across + along_arm(self.turned([m1, m3]));
        if let Some([_, pull_2]) = self.pull {
            free = free + pull_2;
        }
        let holds = zero - free / (one + along_arm(arm(at)));
        let mut force = [[zero; 3]; 2];
        force[sticks] = [loads[sticks], holds, along];
        force[slips] = [loads[slips], across, zero];
        let [u_h, u_2] = self.stuck(y, other);
        let mut lain = self.under([w1, w3, u_h, u_2], force, couple);
        lain.u = self.stuck([lain.w[0], lain.w[1], zero, zero], other);
        lain
    }

    /// Forces and accelerations where both circles stick, and the body rolls, straight on or round its apex.
    pub fn rolls(&self, [w1, w3, ..]: Flat<T>) -> Lain<T> {
        let (Shape { i1, i3, .. }, Border { angle, height, circles: [here, there], .. }) =
            (self.shape, self.border);
        let ((s, c), zero) = (angle, w3.splat(0.0));
        let inertia = i1 * c * c + i3 * s * s + height * height;
        let rolling = rolling_of(angle, w1, w3);
        let (mut push, span) = (zero - c / s * inertia * rolling * rolling, self.border.span());
        if let Some([_, m2, _]) = self.own {
            push = push + m2;
        }
        let mut aside = None;
        if let Some([pull_h, pull_2]) = self.pull {
            push = push + height * pull_h;
            aside = Some(pull_2);
        }
        let loads = [(push - there.lever) / span, (here.lever - push) / span];
        let [turns, mut rolls] = self.parts(self.couple([c * rolling, zero - s * rolling], loads));
        if self.held()[1] {
            rolls = aside.map_or(zero, |aside| zero - height * aside);
        }
        let d = zero - aside.map_or(rolls, |aside| rolls + height * aside) / inertia;
        let (mut all, apart) = (zero - height * d, (i1 - i3) * s * c * d - turns);
        if let Some(aside) = aside {
            all = all - aside;
        }
        let across = [(apart - there.lever * all) / span, (here.lever * all - apart) / span];
        let force = [[loads[0], across[0], zero], [loads[1], across[1], zero]];
        Lain { force, w: [c * d, zero - s * d], u: [zero; 2], couple: [zero, rolls] }
    }

    /// The friction along e_h of both circles together, while the body rolls round its apex.
    pub fn pulls_to_apex(&self, [w1, w3, ..]: Flat<T>) -> T {
        let (s, c) = self.border.angle;
        let rolling = rolling_of((s, c), w1, w3);
        let pull = c / s * self.border.height * rolling * rolling;
        self.pull.map_or(pull, |[pull_h, _]| pull - pull_h)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::body::Circle;
    use crate::laws::loss::{Law, Ways};
    use nalgebra::Vector3;

    /// Numbers between 0 and 1 without a pattern.
    struct Draws(f64);

    impl Draws {
        fn next(&mut self) -> f64 {
            self.0 = (self.0 + 0.618_033_988_749_894_9).fract();
            (self.0 * 7919.0).fract()
        }

        fn within(&mut self, low: f64, high: f64) -> f64 {
            low + (high - low) * self.next()
        }

        /// A body with two circles, such as a cup, a cone or two balls.
        fn body(&mut self) -> Body {
            let (far, rounds) = (self.within(0.3, 4.0), self.next() < 0.5);
            let mut circle = |depth| Circle {
                radius: if self.next() < 0.2 { 0.0 } else { self.within(0.1, 1.0) },
                depth,
                fillet: if rounds { self.within(0.05, 0.25) } else { 0.0 },
            };
            let circles = [circle(0.5 * far), circle(-0.5 * far)];
            let i3 = self.within(0.1, 0.9);
            Body::profile(&circles, self.within(0.51, 1.5) * i3, i3).unwrap()
        }
    }

    /// Newton's and Euler's equations in the frame that turns with the contact: the errors of w1', w2' and w3', and the
    /// rates of the slips of both circles. The velocity of the contact of circle i is v + w x r_i.
    fn newton(
        law: &Lying<f64>,
        [w1, w3, u_h, u_2]: Flat<f64>,
        at: &Lain<f64>,
        m: [f64; 3],
    ) -> (Vector3<f64>, [[f64; 2]; 2]) {
        let (s, c) = law.border.angle;
        let (z, h, across) = (Vector3::new(s, 0.0, c), Vector3::new(c, 0.0, -s), Vector3::y());
        let (w, turns) = (Vector3::new(w1, 0.0, w3), z * (w1 / s));
        let arms = law.border.circles.map(|circle| h * circle.lever - z * law.border.height);
        let v = h * u_h + across * u_2 - w.cross(&arms[0]);
        let forces = at.force.map(|[n, f_2, f_h]| z * n + across * f_2 + h * f_h);
        let inertia =
            |w: Vector3<f64>| Vector3::new(law.shape.i1 * w.x, law.shape.i1 * w.y, law.shape.i3 * w.z);
        let torque = arms[0].cross(&forces[0]) + arms[1].cross(&forces[1]) + Vector3::from(m);
        let d = Vector3::new(at.w[0], 0.0, at.w[1]);
        let off = inertia(d) + turns.cross(&inertia(w)) - torque;
        let [pull_h, pull_2] = law.pull.unwrap_or_default();
        let gained = forces[0] + forces[1] - z + h * pull_h + across * pull_2 - turns.cross(&v);
        (off, arms.map(|arm| gained + d.cross(&arm)).map(|u| [u.dot(&h), u.dot(&across)]))
    }

    #[test]
    fn a_body_on_two_unequal_circles_moves_as_newton_and_euler_say_whatever_slips() {
        let mut draws = Draws(0.3);
        for _ in 0..2000 {
            let body = draws.body();
            let mut losses = Losses::NONE;
            if draws.next() < 0.5 {
                losses = losses
                    .with(Law::RollingResistance, 0.05)
                    .with(Law::AirLinear, 0.02)
                    .with(Law::Drilling, 0.01);
            }
            let mut law = Lying::on(&body, &Friction::coulomb(draws.within(0.05, 0.4)), &losses);
            if draws.next() < 0.5 {
                law.pull = Some([draws.within(-0.5, 0.5), draws.within(-0.5, 0.5)]);
            }
            let mut y: Flat<f64> = core::array::from_fn(|_| draws.within(-2.0, 2.0));
            let (w_z, w_h) =
                (drilling_of(law.border.angle, y[0], y[1]), rolling_of(law.border.angle, y[0], y[1]));
            if let Some(losses) = &mut law.losses {
                losses.ways =
                    Some(Ways { contour: -w_h.signum(), drilling: w_z.signum(), ..Ways::default() });
            }
            let other = draws.next() < 0.5;
            let kind = (draws.next() * 3.0) as usize;
            let at = match kind {
                0 => law.slipping(y),
                1 => {
                    [y[2], y[3]] = law.stuck(y, other);
                    law.pivots(y, other, w_z.signum())
                }
                _ => {
                    let (s, c) = law.border.angle;
                    y = [c * w_h, -s * w_h, 0.0, 0.0];
                    law.rolls(y)
                }
            };
            let loads = at.force.map(|force| force[0]);
            let m = law.couple([y[0], y[1]], loads);
            let mut pressed = at;
            if kind == 2 {
                // How both circles share the friction along e_h is not determined.
                pressed.force[0][2] += law.pulls_to_apex(y);
            }
            let (off, rates) = newton(&law, y, &pressed, m);
            let size = 1e-12 * (1.0 + loads[0].abs() + loads[1].abs()) * (1.0 + off.norm().max(20.0));
            assert!(off.norm() < size, "{kind}, {other}: {off:?}, {body:?}");
            assert!((loads[0] + loads[1] - 1.0).abs() < size);
            let told = rates[0];
            let apart = (told[0] - at.u[0]).hypot(told[1] - at.u[1]);
            assert!(apart < size, "{kind}, {other}: {told:?}, {:?}", at.u);
            match kind {
                1 => assert!(rates[usize::from(other)].iter().all(|u| u.abs() < size), "{other}: {rates:?}"),
                2 => assert!(rates.iter().flatten().all(|u| u.abs() < size), "{rates:?}"),
                _ => {
                    let slips = [[y[2], y[3]], law.other_slip(y)];
                    for (u, [n, f_2, f_h]) in slips.into_iter().zip(at.force) {
                        let [d_h, d_2] = law.drag(law.strength[0], u);
                        assert!((f_h + n * d_h).hypot(f_2 + n * d_2) < size);
                    }
                }
            }
        }
    }

    #[test]
    fn a_cone_that_rolls_has_the_energy_of_landau_and_lifshitz_and_a_cup_rises_where_it_should() {
        for height in [0.5, 1.0, 2.0, 5.0] {
            let circle = |radius, depth| Circle { radius, depth, fillet: 0.0 };
            let (i1, i3) = (3.0 / 20.0 + 3.0 / 80.0 * height * height, 0.3);
            let cone =
                Body::profile(&[circle(0.0, 0.75 * height), circle(1.0, -0.25 * height)], i1, i3).unwrap();
            let law = Lying::on(&cone, &Friction::coulomb(0.5), &Losses::NONE);
            let ((s, c), z) = (law.border.angle, law.border.height);
            let inertia = i1 * c * c + i3 * s * s + z * z;
            let expected = 3.0 * height * height / 40.0 * (1.0 + 5.0 * s * s);
            assert!((0.5 * inertia * (s / c) * (s / c) - expected).abs() < 1e-14 * expected.max(1.0));
        }
        // A frustum of radii 0.7 and 1 and of height 2: its narrow end rises at this rate of turning.
        let circle = |radius, depth| Circle { radius, depth, fillet: 0.0 };
        let low = 9.78 / 8.76;
        let cup =
            Body::profile(&[circle(0.7, low), circle(1.0, low - 2.0)], 0.512_453_524_7, 0.379_876_712_3)
                .unwrap();
        assert!((cup.theta_end() - 1.421_906_379_2).abs() < 1e-10);
        let law = Lying::on(&cup, &Friction::coulomb(1.0), &Losses::NONE);
        assert!((law.border.span() - 2.022_374_841_6).abs() < 1e-10);
        let ((s, c), rate) = (law.border.angle, 0.370_198_716_6);
        let rolling = rate * s / c;
        for (by, rises) in [(0.9999, false), (1.0001, true)] {
            let w_h = by * rolling;
            let at = law.rolls([c * w_h, -s * w_h, 0.0, 0.0]);
            assert_eq!(at.force[0][0] < 0.0, rises);
        }
        assert!((law.pulls_to_apex([c * rolling, -s * rolling, 0.0, 0.0]) - 0.7838).abs() < 5e-5);
    }
}
