//! Flight: the free motion of a body of revolution in the air, in closed form.
//!
//! ```text
//! the centre runs on a parabola; L and w3 stay;   n = L/|L|,   Lam = |L|/I1,   sig = w3 (1 - I3/I1)
//! cos a = n.z,   cos b = n.e3,   C = C0 + Lam t the angle at n from z to e3
//! cos theta = cos a cos b + sin a sin b cos C       w1 = W (cos a sin b - sin a cos b cos C)/s,   w2 = -W sin a sin C/s
//! W = hypot(w1, w2) stays;   phi = phi0 - [X - Y],   psi = psi0 + sig t - [X + Y]       Napier's analogies
//! tan X = cos((a-b)/2)/cos((a+b)/2) tan D,   tan Y = sin((a-b)/2)/sin((a+b)/2) tan D,   D = (pi - C)/2
//! ```
//! Theta may pass pi/2 or come near a pole (theta = 0 or pi). Near the poles sums are written so that no digits are
//! lost. At a start on a pole phi is that with which the axis leaves the pole, and X and Y are their limits. The
//! symmetric top without a couple is Poinsot's and Euler's; Napier's analogies are those of spherical trigonometry.
//! [`lands`] computes the landing.
//!
//! Error: a few roundings times 1 + Lam t, and of w1, w2, phi and psi over sin(theta).

pub(crate) mod air;
pub(crate) mod flies;
pub(crate) mod lands;

use super::write::posed;
use crate::laws::body::{Body, Landings, MOST_CIRCLES, Rim, Shape};
use crate::laws::pose::Pose;
use crate::laws::state::State;
use crate::methods::flow::{Exhausted, Spent, Steps};
use crate::motions::walk::hops::Leaves;
use crate::motions::walk::numbers::carried_at;
use core::f64::consts::{FRAC_PI_2, PI};

/// A body in the air, or in an impact, with its state counted from one of its rims.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Aloft {
    /// Sine and cosine of theta.
    pub angle: (f64, f64),
    pub w: [f64; 3],
    /// The velocity of the lowest point of the rim over the table, along e_h and e2; `lift` is its upward velocity.
    pub slip: [f64; 2],
    pub lift: f64,
    /// The height of the lowest point of the rim above the table.
    pub height: f64,
    /// phi, psi, and the point (x, y) of the table below the lowest point of the rim.
    pub pose: [f64; 4],
    /// The rate at which the table turns.
    pub om: f64,
}

impl Aloft {
    pub fn state(&self) -> State {
        let [w1, w2, w3] = self.w;
        State { theta: self.angle.0.atan2(self.angle.1), w1, w2, w3 }
    }

    pub fn pose(&self) -> Pose {
        posed(self.pose, self.height)
    }

    /// The velocity of the table below the lowest point of the rim, along e_h and e2.
    fn carried(&self) -> [f64; 2] {
        let [phi, _, x, y] = self.pose;
        carried_at(self.om, phi.sin_cos(), [x, y])
    }

    /// The same body on a pole (theta = 0 or pi) with the phi with which its axis leaves the pole; the lowest point
    /// may then be the opposite point of its face.
    fn leaving_pole(&self, shape: &Shape<f64>) -> Self {
        if self.angle.0 != 0.0 || self.angle.1 * self.w[1] <= 0.0 { *self } else { self.opposite(shape) }
    }

    /// The same body on a pole (theta = 0 or pi), with a state that refers to the opposite point of its face.
    pub fn opposite(&self, shape: &Shape<f64>) -> Self {
        let ((_, c), [w1, w2, w3], [u, v], [phi, psi, x, y]) = (self.angle, self.w, self.slip, self.pose);
        let [radius, lever] = [shape.rim.radius(self.angle), shape.rim.lever(self.angle)].map(|x| 2.0 * x);
        let (sin, cos) = phi.sin_cos();
        Self {
            w: [0.0 - w1, 0.0 - w2, w3],
            slip: [0.0 - u, -(radius * w3) - v - lever * self.om],
            lift: self.lift + lever * w2,
            pose: [phi + PI, psi - c * PI, x - lever * cos, y - lever * sin],
            ..*self
        }
    }

    /// The same body with a state that refers to the rim `there` instead of `here`.
    pub fn on_other_rim(&self, [here, there]: &[Rim<f64>; 2]) -> Self {
        let (angle @ (s, c), [w1, w2, w3], [phi, psi, x, y]) = (self.angle, self.w, self.pose);
        let less = here.less(there);
        let (apart, above) = (less.lever(angle), less.height(angle));
        let (deep, wide, [u_h, u_2]) = (less.depth(angle), less.radius(angle), self.slip);
        Self {
            angle: (s, 0.0 - c),
            w: [w1, 0.0 - w2, 0.0 - w3],
            slip: [0.0 - u_h - above * w2, deep * w1 - wide * w3 - u_2 - apart * self.om],
            lift: self.lift + apart * w2,
            height: self.height + above,
            pose: [phi + PI, 0.0 - psi, x - apart * phi.cos(), y - apart * phi.sin()],
            om: self.om,
        }
    }
}

/// The time of the first landing, and the index of the circle in [`Landings`]; None without a landing.
pub(crate) type FirstLanding = Option<(f64, usize)>;

/// A flight, with or without losses in the air.
pub(crate) trait Flies {
    /// The first time after the start at which a rim lands, and the index of the rim; None if no rim lands up to the
    /// time `until`. `leaves` says how each rim begins its flight; `limits` limits the steps of a flight that is
    /// integrated.
    fn lands(
        &mut self,
        leaves: [Leaves; MOST_CIRCLES],
        until: f64,
        limits: Steps,
        go_on: &mut dyn FnMut() -> bool,
    ) -> Result<FirstLanding, Exhausted>;
    /// The body at a time since the start, counted from the same rim, and the energy lost to the air.
    fn at(&self, t: f64) -> (Aloft, f64);
    /// The flight of the same body without losses.
    fn free(&self) -> &Flight;
    /// The number of evaluations and the estimated errors of the steps; None for a closed form.
    fn spent(&self) -> Option<Spent> {
        None
    }
}

/// If abs(cos(theta)) is above this, its small distance from 1 is computed, which keeps more digits.
const FAR: f64 = 0.9;

/// The free flight of a body, in closed form, from its start.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Flight {
    shape: Shape<f64>,
    /// All circles that may land; `reach` is the largest distance of their points from the centre of mass.
    landings: Landings,
    reach: f64,
    /// The start as given; `from` is the same start, but on a pole with the phi with which the axis leaves the pole.
    given: Aloft,
    from: Aloft,
    /// Velocity of the centre of mass along the e_h and e2 of the start, and upwards; `height` is its height at the
    /// start.
    velocity: [f64; 3],
    height: f64,
    /// Lam = |L|/I1; `spin` is sig = w3 (1 - I3/I1), and `transverse` W = hypot(w1, w2).
    rate: f64,
    spin: f64,
    /// -1 if the angles are those of the mirror image of the motion, else 1.
    image: f64,
    transverse: f64,
    /// The angle a between L and the vertical; `b` is that between L and the axis, `begin` is C0, and `wide` is sin a
    /// sin b.
    a: f64,
    b: f64,
    begin: f64,
    wide: f64,
    /// sin(a) sin(b) cos(C0) and sin(a) sin(b) sin(C0), from which cos(theta) follows in time.
    swing: [f64; 2],
    /// sin((a - b)/2) and cos((a + b)/2) of the angles a and b of L with the vertical and with the axis; one of them
    /// is exactly 0 at a start on a pole.
    apart: [f64; 2],
    /// The ratios of tan X and of tan Y to tan D in Napier's analogies; `napier` is X and Y at the start.
    ratios: [f64; 2],
    napier: [f64; 2],
    /// Whether the body only tumbles in a vertical plane, so that rounding must not make its axis leave the plane.
    planar: bool,
    /// The tangent of the slope: the acceleration of the centre along x.
    tilt: f64,
}

impl Flight {
    pub fn new(body: &Body, given: &Aloft, tilt: f64) -> Self {
        let shape = body.shape();
        let from = &given.leaving_pole(&shape);
        let (Shape { rim, i1, i3 }, (s, c), [w1, w2, w3]) = (shape, from.angle, from.w);
        let landings = body.landings();
        // The mirror image of a motion is computed by the same numbers.
        let image = if w3 < 0.0 || w3 == 0.0 && w1 < 0.0 { -1.0 } else { 1.0 };
        let (w1, w3) = (image * w1, image * w3);
        let (height, lever) = (rim.height(from.angle), rim.lever(from.angle));
        let transverse = w1.hypot(w2);
        let (axial, across) = (i3 * w3, i1 * transverse);
        let size = axial.hypot(across);
        // The components of L along e_h, e2 and z.
        let [l_h, l_2, l_z] = [i1 * w1 * c - axial * s, i1 * w2, i1 * w1 * s + axial * c];
        let (a, b) = (l_h.hypot(l_2).atan2(l_z), across.atan2(axial));
        let upright = if s == 0.0 { c } else { 0.0 };
        let begin = (-s * w2 * size).atan2(c * i1 * transverse * transverse - axial * w1 * s);
        let begin = if upright < 0.0 { PI } else { begin };
        let [out, on] = from.carried();
        let velocity = [
            from.slip[0] + out + height * w2,
            from.slip[1] + on - image * (rim.depth(from.angle) * w1 - rim.radius(from.angle) * w3),
            from.lift + lever * w2,
        ];
        let mut flight = Self {
            shape,
            landings,
            reach: landings.rims[..landings.circles].iter().map(Rim::reach).fold(0.0, f64::max),
            given: *given,
            from: *from,
            velocity,
            height: from.height + height,
            rate: size / i1,
            spin: w3 * (1.0 - i3 / i1),
            image,
            transverse,
            a,
            b,
            begin,
            wide: a.sin() * b.sin(),
            swing: [begin.cos(), begin.sin()].map(|x| a.sin() * b.sin() * x),
            apart: [0.0; 2],
            ratios: [0.0; 2],
            napier: [0.0; 2],
            planar: w1 == 0.0 && w3 == 0.0,
            tilt,
        };
        let (less, sum) = (0.5 * (a - b), 0.5 * (a + b));
        // On a pole a = b, or a + b = pi.
        let [down, up] =
            [if upright > 0.0 { 0.0 } else { less.sin() }, if upright < 0.0 { 0.0 } else { sum.cos() }];
        flight.apart = [down, up];
        flight.ratios = [less.cos() / up, down / sum.sin()].map(|ratio| {
            let size = if ratio.is_nan() { 1.0 } else { ratio.abs().clamp(1e-300, 1e300) };
            size.copysign(ratio)
        });
        flight.napier = if upright == 0.0 { flight.analogies(0.0) } else { [upright * FRAC_PI_2, 0.0] };
        flight
    }

    /// The angles X and Y of Napier's analogies at a time, continuous over any number of turns.
    fn analogies(&self, t: f64) -> [f64; 2] {
        let (sin, cos) = (0.5 * (PI - self.begin - self.rate * t)).sin_cos();
        let turns = 0.5 * (PI - self.begin - self.rate * t);
        self.ratios.map(|ratio| {
            let size = ratio.abs();
            let more = ((size - 1.0) * sin * cos).atan2(cos * cos + size * sin * sin);
            1f64.copysign(ratio) * (turns + more)
        })
    }

    /// The change of cos(theta) since the start, and its time derivative.
    fn cosine(&self, t: f64) -> [f64; 2] {
        let (sin, cos) = (0.5 * self.rate * t).sin_cos();
        let ([p, q], twice) = (self.swing, 2.0 * sin);
        [-(twice * (p * sin + q * cos)), -(self.rate * (q + twice * (p * cos - q * sin)))]
    }

    /// Sine and cosine of theta at a time.
    fn angle(&self, t: f64) -> (f64, f64) {
        self.angle_of(t, self.cosine(t)[0])
    }

    /// Sine and cosine of theta at a time, where the change of the cosine is known.
    fn angle_of(&self, t: f64, change: f64) -> (f64, f64) {
        let c = self.from.angle.1 + change;
        if self.rate == 0.0 {
            return self.from.angle;
        }
        if c.abs() < FAR {
            return (((1.0 - c) * (1.0 + c)).sqrt(), c);
        }
        // Near a pole both of these are sums of positive terms.
        let (half, [less, more]) = (0.5 * (self.begin + self.rate * t), self.apart);
        let down = 2.0 * (less * less + self.wide * half.sin() * half.sin());
        let up = 2.0 * (more * more + self.wide * half.cos() * half.cos());
        ((down * up).sqrt(), if down < 1.0 { 1.0 - down } else { up - 1.0 })
    }

    /// w1 and w2 at a time, where sine and cosine of theta are known.
    fn tilting(&self, t: f64, (s, _): (f64, f64)) -> [f64; 2] {
        let (sin, cos) = (self.begin + self.rate * t).sin_cos();
        let half = 0.5 * (self.begin + self.rate * t);
        let swing = self.a.sin() * self.b.cos();
        let along = if cos > 0.0 {
            self.apart[0] * -2.0 * (0.5 * (self.a - self.b)).cos() + 2.0 * swing * half.sin() * half.sin()
        } else {
            self.apart[1] * 2.0 * (0.5 * (self.a + self.b)).sin() - 2.0 * swing * half.cos() * half.cos()
        };
        let per = self.transverse / s.max(f64::MIN_POSITIVE);
        // The sum turns -0 into 0.
        [if self.planar { 0.0 } else { self.image * along * per } + 0.0, 0.0 - self.a.sin() * sin * per]
    }

    /// The body at a time since the start, counted from the same rim.
    fn flown(&self, t: f64) -> Aloft {
        if t == 0.0 {
            return self.given;
        }
        if self.transverse == 0.0 && self.from.angle.0 == 0.0 {
            // Only the sum of phi and psi, or their difference, turns.
            let spin = self.from.w[2];
            return self.placed(t, self.from.angle, [0.0, 0.0, spin], [0.0, spin * t]);
        }
        let angle = self.angle(t);
        let [w1, w2] = self.tilting(t, angle);
        let [x, y] = self.analogies(t);
        let [x, y] = [x - self.napier[0], y - self.napier[1]];
        let turned = [y - x, self.spin * t - (x + y)].map(|angle| self.image * angle);
        self.placed(t, angle, [w1, w2, self.from.w[2]], turned)
    }

    /// The body at a time since the start, from its inclination and angular velocity; `turned` has the angles by
    /// which phi and psi have grown.
    fn placed(&self, t: f64, angle: (f64, f64), w: [f64; 3], turned: [f64; 2]) -> Aloft {
        self.placed_beside(t, angle, w, turned, [0.0; 4])
    }

    /// The body at a time since the start, where a force has moved its centre off the parabola: by x and y, and in
    /// velocity along x and y.
    fn placed_beside(
        &self,
        t: f64,
        angle: (f64, f64),
        [w1, w2, w3]: [f64; 3],
        turned: [f64; 2],
        [x, y, faster_x, faster_y]: [f64; 4],
    ) -> Aloft {
        let (rim, from) = (self.shape.rim, &self.from);
        let (phi, psi) = (from.pose[0] + turned[0], from.pose[1] + turned[1]);
        let [forth, aside, up] = self.velocity;
        let (sin, cos) = turned[0].sin_cos();
        let (v_h, v_2) = (forth * cos + aside * sin, aside * cos - forth * sin);
        let (sin0, cos0) = from.pose[0].sin_cos();
        let (begin, lever) = (rim.lever(from.angle), rim.lever(angle));
        let (moved_x, moved_y) = ((forth * cos0 - aside * sin0) * t, (forth * sin0 + aside * cos0) * t);
        let falls = self.tilt * t;
        let ((sin, cos), faster) = (phi.sin_cos(), [falls + faster_x, faster_y]);
        let (moved_x, moved_y) = (moved_x + 0.5 * falls * t + x, moved_y + y);
        let (v_h, v_2) = if faster == [0.0; 2] {
            (v_h, v_2)
        } else {
            (v_h + faster[0] * cos + faster[1] * sin, v_2 - faster[0] * sin + faster[1] * cos)
        };
        let mut flown = Aloft {
            angle,
            w: [w1, w2, w3],
            slip: [v_h - rim.height(angle) * w2, v_2 + rim.depth(angle) * w1 - rim.radius(angle) * w3],
            lift: up - t - lever * w2,
            height: self.height + t * (up - 0.5 * t) - rim.height(angle),
            pose: [
                phi,
                psi,
                from.pose[2] - begin * cos0 + moved_x + lever * phi.cos(),
                from.pose[3] - begin * sin0 + moved_y + lever * phi.sin(),
            ],
            om: from.om,
        };
        let [out, on] = flown.carried();
        flown.slip = [flown.slip[0] - out, flown.slip[1] - on];
        flown
    }

    /// The rounding error of the height of a rim at a time.
    pub fn doubt_of_height(&self, t: f64) -> f64 {
        let reach = self.reach;
        4.0 * f64::EPSILON * (self.from.height + t * (1.0 + self.velocity[2].abs() + self.rate * reach))
    }

    /// The angle by which the body has turned since the start of the flight.
    pub fn turns(&self, t: f64) -> f64 {
        self.rate * t
    }

    /// The error of the state at a time, in units of rounding, away from the poles.
    pub fn roundings(&self, t: f64) -> f64 {
        4.0 * (1.0 + self.turns(t))
    }

    /// The rounding error of the state at a time.
    pub fn doubt(&self, t: f64, at: &Aloft) -> f64 {
        let fastest = at.w.iter().fold(1.0, |most: f64, w| most.max(w.abs()));
        // Where the axis is vertical, or stays in a plane, nothing is turned by an error of phi.
        let turned = if at.angle.0 > 0.0 && !self.planar { at.angle.0 } else { 1.0 };
        self.roundings(t) * f64::EPSILON * fastest / turned
    }
}
