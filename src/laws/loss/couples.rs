//! The couple of several laws together, over any type of number, and the kinematics on which the laws depend.
//!
//! ```text
//! m = m0 + N mN,   P = P0 + N PN          of the laws that are present
//! ```
//! `Ways` holds the signs of psi', of the drilling, and of the rocking of a body that only rocks. A caller can hold
//! these signs fixed within a step, so that the couple is smooth in every step. The error is that of the laws.

use super::{COUNT, Law, Losses, Speed};
use crate::laws::body::{Body, Rim};
use crate::laws::state::{State, drilling_of, rolling_of, spin_of};
use crate::numbers::{Dual, Real, here};

/// The kinematics of a body on which the laws depend.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Kinematics<T> {
    /// Sine and cosine of theta.
    pub angle: (T, T),
    pub w: [T; 3],
    /// The spin psi', the rate of turning about the symmetry axis relative to e1, e2, e3.
    pub spin: T,
    /// The radius A of the circle of contact.
    pub radius: T,
    /// The signs -1, 0 or 1 of the spin psi' and of the drilling w_z.
    pub signs: [T; 2],
    /// The signs of the rolling w_h and the rocking w2, for a body that only rolls or only rocks, where a caller holds
    /// that sign fixed; the other sign is 0.
    pub only: Option<[T; 2]>,
    /// The rate at which the table turns; 0 if it does not.
    pub om: T,
}

/// The sign of a number: -1, 0 or 1.
#[inline(always)]
fn sign<T: Real>(x: T) -> T {
    let (zero, one) = (x.splat(0.0), x.splat(1.0));
    x.select_lt(zero, -one, zero.select_lt(x, one, zero))
}

impl<T: Real> Kinematics<T> {
    /// The kinematics from sine and cosine of theta, phi' = w1/s and the angular velocity w along e1, e2, e3.
    #[inline(always)]
    pub fn of(rim: &Rim<T>, angle: (T, T), precession: T, w: [T; 3]) -> Self {
        let (s, c) = angle;
        let spin = w[2] - c * precession;
        let zero = s.splat(0.0);
        let radius = rim.radius(angle);
        let mut seen = Self { angle, w, spin, radius, signs: [zero; 2], only: None, om: zero };
        seen.signs = [sign(spin), sign(seen.drilling())];
        seen
    }

    /// These kinematics over a table that turns at the rate `om`.
    #[inline(always)]
    fn over(mut self, om: T) -> Self {
        self.om = om;
        self.signs[1] = sign(self.drilling());
        self
    }

    /// The component w_h of the angular velocity along e_h: the rolling.
    #[inline(always)]
    pub fn rolling(&self) -> T {
        -(self.angle.0 * self.spin)
    }

    /// The drilling: the angular velocity w_z about the vertical, relative to the table.
    #[inline(always)]
    pub fn drilling(&self) -> T {
        self.angle.0.mac(self.w[0], self.angle.1 * self.w[2]) - self.om
    }

    /// The square w.w of the magnitude of the angular velocity.
    #[inline(always)]
    pub fn square(&self) -> T {
        let [w1, w2, w3] = self.w;
        w1.mac(w1, w2.mac(w2, w3 * w3))
    }

    /// The couple `push` h/s, where h = c e1 - s e3. It takes the power push psi', since h.w = -s psi'.
    #[inline(always)]
    pub fn along(&self, push: T) -> [T; 3] {
        let (s, c) = self.angle;
        [c / s * push, push.splat(0.0), -push]
    }
}

impl Kinematics<f64> {
    pub fn of_state(body: &Body, y: &State) -> Self {
        let angle = y.theta.sin_cos();
        Self::of(&body.shape().rim, angle, y.w1 / angle.0, [y.w1, y.w2, y.w3])
    }
}

/// The couple of some losses: a part that does not depend on the normal force, and one that is proportional to it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Couple<T> {
    pub free: [T; 3],
    pub pressed: [T; 3],
}

impl<T: Real> Couple<T> {
    /// The total couple under this normal force: free + normal pressed.
    #[inline(always)]
    pub fn under(&self, normal: T) -> [T; 3] {
        let ([a, b, c], [x, y, z]) = (self.free, self.pressed);
        [normal.mac(x, a), normal.mac(y, b), normal.mac(z, c)]
    }

    /// The sum of this couple and another one.
    fn plus(&self, other: &Self) -> Self {
        let sum = |a: [T; 3], b: [T; 3]| core::array::from_fn(|i| a[i] + b[i]);
        Self { free: sum(self.free, other.free), pressed: sum(self.pressed, other.pressed) }
    }
}

/// A couple in addition to the losses: that of a user-defined law, or one that is linear in the normal force. The type
/// `()` means none, and costs no code.
pub(crate) trait OwnCouple<T: Real>: Copy {
    /// Whether there is such a couple.
    #[inline(always)]
    fn is_there(&self) -> bool {
        false
    }

    /// The couple, if it is linear in the normal force and the same in all states; else None.
    #[inline(always)]
    fn couple(&self) -> Option<&Couple<T>> {
        None
    }

    /// The couple of a user-defined law as a linear function of N, exact at the normal force that `normal` gives for
    /// such a couple.
    #[inline(always)]
    fn solved_couple(&self, _seen: &Kinematics<T>, _normal: impl Fn(&Couple<T>) -> T) -> Option<Couple<T>> {
        None
    }

    /// The power that a user-defined law takes under a normal force; None without such a law.
    #[inline(always)]
    fn power_taken(&self, _seen: &Kinematics<T>, _normal: T) -> Option<T> {
        None
    }
}

impl<T: Real> OwnCouple<T> for () {}

impl<T: Real> OwnCouple<T> for Option<Couple<T>> {
    #[inline(always)]
    fn is_there(&self) -> bool {
        self.is_some()
    }

    #[inline(always)]
    fn couple(&self) -> Option<&Couple<T>> {
        self.as_ref()
    }
}

/// The kinds of motion that dry friction keeps at rest.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Holds {
    /// The rolling of the contact along the rim: psi' = 0 is held by a couple h/s.
    pub contour: bool,
    /// The drilling: w_z = 0 is held by a couple about the vertical.
    pub drilling: bool,
    /// Rolling and rocking, by a horizontal couple, so that the body only turns about the vertical.
    pub rolling: bool,
}

/// The signs of the motions that dry friction resists, held fixed by a caller: of psi', of w_z, and of w_h and w2.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Ways<T = f64> {
    pub contour: T,
    pub drilling: T,
    /// The components (rolling, rocking) of the direction of (w_h, w2), where a caller fixes it: (0, 1) or (0, -1) for
    /// a body that only rocks, or the direction in which rolling and rocking begin. Otherwise both are 0, as always in
    /// SIMD lanes.
    pub rolling: f64,
    pub rocking: f64,
    pub holds: Holds,
}

impl<T: Real> Ways<T> {
    /// Signs that are all 0, with no motion held at rest.
    #[inline(always)]
    pub fn moving(like: T) -> Self {
        let zero = like.splat(0.0);
        Self { contour: zero, drilling: zero, rolling: 0.0, rocking: 0.0, holds: Holds::default() }
    }
}

/// The losses in the form that the equations of motion use, of one body or of eight in SIMD lanes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Couples<T, G = ()> {
    pub(super) coefficients: [T; COUNT],
    pub(super) present: [bool; COUNT],
    /// The signs of the motions that dry friction resists, where a caller holds them fixed within a step; else None.
    pub ways: Option<Ways<T>>,
    /// The horizontal acceleration of a tilted table's gravity on the centre, along e_h and e2; None on a level table.
    pub pull: Option<[T; 2]>,
    /// The angular velocity of a table that turns; None if it does not turn.
    pub om: Option<T>,
    pub given: G,
}

/// Where a law is not smooth at zero speed, a step may change the speed by this share of it, or by `NEAR` if that is more.
const SPEED_CHANGE_SHARE: f64 = 0.5;
pub(crate) const NEAR: f64 = 1e-9;
/// Speeds up to this have no sign: near rest, rounding may give either sign.
pub(crate) const SLACK: f64 = 4e-15;

impl<T: Real, G: OwnCouple<Dual<T>>> Couples<Dual<T>, G> {
    /// The longest step that these laws allow, since the roots that they contain are not smooth where a speed vanishes.
    /// `paced` means that rolling resistance is nevertheless smooth in the variable of the integration.
    #[inline(always)]
    pub fn longest(&self, seen: &Kinematics<Dual<T>>, paced: bool) -> T {
        let number = |x: f64| seen.spin.value.splat(x);
        let mut most = number(f64::INFINITY);
        for square in self.roots(seen, paced).into_iter().flatten() {
            // `square` is x^2 with the slope 2 x x', so that `twice` is 2 |x'|.
            let x = square.value.sqrt();
            let twice = square.slope.abs() / x;
            // Where both x and its slope are zero the quotient is NaN and limits nothing.
            most = ((number(2.0 * SPEED_CHANGE_SHARE) * x).max(number(2.0 * NEAR)) / twice).min(most);
        }
        most
    }
}

/// Dry friction holds a motion at rest up to its limit times 1 + GRACE, so that a released motion moves away from the limit.
pub(crate) const GRACE: f64 = 1e-11;

/// The couple of rolling resistance that keeps a body from rolling and rocking, for a total horizontal couple with the
/// components `across` along h and `along` along e2. Dry friction along the contour exerts as much of `across` as it
/// can.
#[inline(always)]
pub(crate) fn rolling_couple_needed<T: Real>([across, along]: [T; 2], contour: T) -> T {
    let zero = across.splat(0.0);
    let left = (across.abs() - contour).max(zero);
    // The small number keeps the slope of the root finite at zero.
    (left.mac(left, along * along) + zero.splat(1e-300)).sqrt()
}

/// The speed below which a motion that was held counts as at rest, since rounding errors are of this size; s is sin theta.
pub(crate) fn rounded(s: f64, w: [f64; 3]) -> f64 {
    if w == [0.0; 3] { 0.0 } else { 10.0 * SLACK * (1.0 + (w[0] / s).abs()) }
}

/// The velocity x along the direction `way` of 1 or -1, plus `slack`: positive until its sign changes. Without a
/// direction (`way` = 0) the result is 1.
#[inline(always)]
pub(crate) fn going<T: Real>(way: T, x: T, slack: T) -> T {
    let one = x.splat(1.0);
    one.splat(0.5).select_lt(way * way, way * x + slack, one)
}

/// The angular velocity with psi' and w2 reversed, at the same w_z = phi' + c psi'.
pub(crate) fn reversed_turns((s, c): (f64, f64), [w1, w2, w3]: [f64; 3]) -> [f64; 3] {
    let spin = spin_of((s, c), w1, w3);
    [w1 + 2.0 * s * c * spin, -w2, w3 - 2.0 * s * s * spin]
}

/// The speed of rolling and rocking together, sqrt(w_h^2 + w2^2), and its time derivative for the given w'.
pub(crate) fn rolling_growth((s, c): (f64, f64), [w1, w2, w3]: [f64; 3], [d1, d2, d3]: [f64; 3]) -> [f64; 2] {
    // The rolling is w_h = c w1 - s w3.
    let (rolling, rate) =
        (rolling_of((s, c), w1, w3), rolling_of((s, c), d1, d3) + w2 * drilling_of((s, c), w1, w3));
    let speed = rolling.hypot(w2);
    [speed, (rolling * rate + w2 * d2) / speed]
}

/// The losses together with a user-defined couple.
pub(crate) type UnderCouple = Couples<f64, Option<Couple<f64>>>;

impl<G> Couples<f64, G> {
    /// These losses without the laws that act along the contour.
    pub fn off_the_contour(mut self) -> Self {
        for law in Law::ALL.iter().copied().filter(|law| law.is_along_contour()) {
            (self.coefficients[law as usize], self.present[law as usize]) = (0.0, false);
        }
        self
    }

    /// Returns these losses with `law` added.
    #[must_use]
    pub fn resisting(mut self, law: Law, coefficient: f64) -> Self {
        (self.coefficients[law as usize], self.present[law as usize]) = (coefficient, true);
        self
    }

    /// Returns these losses with another couple, `given`.
    #[must_use]
    pub fn beside<H>(self, given: H) -> Couples<f64, H> {
        let Self { coefficients, present, ways, pull, om, .. } = self;
        Couples { coefficients, present, ways, pull, om, given }
    }
}

impl<G: OwnCouple<f64>> Couples<f64, G> {
    /// The losses with a user-defined couple `own` in addition; None if there is neither a loss nor such a couple.
    pub fn with_own(losses: &Losses, own: G) -> Option<Self> {
        (!losses.is_none() || own.is_there()).then(|| Couples::of(losses, |x| x).beside(own))
    }

    /// These losses with the couple of a user-defined law in this state, as a linear function of N that is exact at the
    /// normal force which `normal` gives.
    pub fn linear(&self, seen: &Kinematics<f64>, normal: impl Fn(&Couple<f64>) -> f64) -> UnderCouple {
        let losses = self.at(seen);
        let own = self.given.solved_couple(seen, |own| normal(&losses.plus(own)));
        self.beside(own.or(self.given.couple().copied()))
    }
}

impl Couples<f64> {
    /// Those of the losses that act on a body in the air; None if there are none.
    pub fn in_air(losses: &Losses) -> Option<Self> {
        let mut left = *losses;
        for law in Law::ALL.iter().copied().filter(|law| !law.acts_in_air()) {
            left.coefficients[law as usize] = 0.0;
        }
        Self::some(&left)
    }

    /// The losses in this form; None if no law is present.
    pub fn some(losses: &Losses) -> Option<Self> {
        (!losses.is_none()).then(|| Self::of(losses, |x| x))
    }
}

impl<T: Real> Couples<T> {
    #[inline(always)]
    pub fn of(losses: &Losses, number: impl Fn(f64) -> T) -> Self {
        let coefficients = losses.coefficients.map(number);
        Self {
            coefficients,
            present: losses.coefficients.map(|x| x != 0.0),
            ways: None,
            pull: None,
            om: None,
            given: (),
        }
    }

    /// The losses with these coefficients, of which only the laws in `present` count. `ways` may hold signs fixed.
    #[inline(always)]
    pub fn among(coefficients: [T; COUNT], present: [bool; COUNT], ways: Option<Ways<T>>) -> Self {
        Self { coefficients, present, ways, pull: None, om: None, given: () }
    }
}

impl<T: Real, G: Copy> Couples<T, G> {
    /// Returns these losses on a tilted table, where gravity accelerates the centre by `pull` along e_h and e2.
    #[must_use]
    #[inline(always)]
    pub fn pulled(self, pull: [T; 2]) -> Self {
        Self { pull: Some(pull), ..self }
    }

    /// Returns these losses on a table that turns at the rate `om`, if `turns`.
    #[must_use]
    pub fn over(self, om: T, turns: bool) -> Self {
        Self { om: turns.then_some(om), ..self }
    }

    /// Converts the coefficients and couples to another type of number.
    #[inline(always)]
    pub fn map<U: Real>(&self, number: impl Fn(T) -> U) -> Couples<U, G> {
        let ways = self.ways.map(|ways| Ways {
            contour: number(ways.contour),
            drilling: number(ways.drilling),
            rolling: ways.rolling,
            rocking: ways.rocking,
            holds: ways.holds,
        });
        // In lanes the compiler would not inline the closure of an array's `map`.
        let mut coefficients = [number(self.coefficients[0]); COUNT];
        for (to, from) in coefficients.iter_mut().zip(self.coefficients) {
            *to = number(from);
        }
        let pull = self.pull.map(|[a, b]| [number(a), number(b)]);
        let om = self.om.map(&number);
        Couples { coefficients, present: self.present, ways, pull, om, given: self.given }
    }
}

impl<T: Real, G: OwnCouple<T>> Couples<T, G> {
    /// The couple of all laws and of the user-defined law, as a linear function of N that is exact at the normal force
    /// which `normal` gives.
    #[inline(always)]
    pub fn total_couple(&self, seen: &Kinematics<T>, normal: impl Fn(&Couple<T>) -> T) -> Couple<T> {
        let losses = self.at(seen);
        let own = self.given.solved_couple(
            seen,
            #[inline(always)]
            |own| normal(&losses.plus(own)),
        );
        own.map_or(
            losses,
            #[inline(always)]
            |own| losses.plus(&own),
        )
    }

    /// Returns these losses with another couple, `pressed` times the normal force.
    pub fn with_pressed_couple(&self, pressed: [T; 3]) -> Couples<T, Option<Couple<T>>> {
        let zero = pressed[0].splat(0.0);
        let given = self.given.couple().copied().unwrap_or(Couple { free: [zero; 3], pressed: [zero; 3] });
        let [a, b, c] = given.pressed;
        let pressed = [a + pressed[0], b + pressed[1], c + pressed[2]];
        let &Self { coefficients, present, ways, pull, om, .. } = self;
        Couples { coefficients, present, ways, pull, om, given: Some(Couple { pressed, ..given }) }
    }

    /// The kinematics from the sine s and the cosine of theta, w1/s and w. Signs that a caller holds are kept.
    #[inline(always)]
    pub fn seen(&self, rim: &Rim<T>, angle: (T, T), precession: T, w: [T; 3]) -> Kinematics<T> {
        let mut seen = Kinematics::of(rim, angle, precession, w);
        if let Some(om) = self.om {
            seen = seen.over(om);
        }
        let Some(ways) = self.ways else { return seen };
        let fixed = ways.rocking != 0.0 || ways.rolling != 0.0 || ways.holds.rolling;
        let only = fixed.then(|| [ways.rolling, ways.rocking].map(|way| angle.0.splat(way)));
        // Where friction holds the contact along the rim, psi' is zero: its rounding, under a couple that grows with
        // psi'/s^2, would seem to exceed the limit of friction near the table.
        let rests = ways.holds.contour || ways.holds.rolling;
        let spin = if rests { seen.spin.splat(0.0) } else { seen.spin };
        Kinematics { spin, signs: [ways.contour, ways.drilling], only, ..seen }
    }

    /// Which laws are present: an array in the order of [`Law::ALL`].
    pub fn present(&self) -> [bool; COUNT] {
        self.present
    }

    /// Whether some law has a couple about e2, the axis about which the body rocks.
    #[inline(always)]
    pub fn tilts(&self) -> bool {
        self.pull.is_some()
            || self.given.is_there()
            || self.has_any(
                #[inline(always)]
                |law| law.tilts(),
            )
    }

    /// Whether the couple of some law along the contour grows with the speed of the contact along the rim.
    #[inline(always)]
    pub fn is_soft(&self) -> bool {
        self.has_any(
            #[inline(always)]
            |law| law.is_soft(),
        )
    }

    /// Whether a face lands only after infinitely many turns, unless a law along the contour stops the contact.
    #[inline(always)]
    pub fn turn_endlessly(&self) -> bool {
        self.has_any(
            #[inline(always)]
            |law| law.turns_endlessly(),
        )
    }

    /// Whether some law other than rolling resistance contains the root of a squared speed.
    #[inline(always)]
    pub fn has_roots(&self) -> bool {
        self.has_root(Speed::Spin) || self.has_root(Speed::Whole)
    }

    /// Whether some law contains the root of the square of this speed.
    #[inline(always)]
    fn has_root(&self, speed: Speed) -> bool {
        self.has_any(
            #[inline(always)]
            |law| law.root() == Some(speed),
        )
    }

    /// Whether a law for which `kind` is true is present.
    #[inline(always)]
    fn has_any(&self, kind: impl Fn(Law) -> bool) -> bool {
        let mut has = false;
        Law::each(
            #[inline(always)]
            |law| has |= kind(law) && self.has(law),
        );
        has
    }

    /// The kinds of motion that dry friction holds at rest.
    #[inline(always)]
    pub fn holds(&self) -> Holds {
        self.ways.as_ref().map_or(Holds::default(), |ways| ways.holds)
    }

    /// Whether this law is present.
    #[inline(always)]
    pub fn has(&self, law: Law) -> bool {
        self.present[law as usize]
    }

    /// Sets the coefficient of a law.
    pub fn sets(&mut self, law: Law, coefficient: T) {
        self.coefficients[law as usize] = coefficient;
    }

    /// The coefficient of this law.
    #[inline(always)]
    pub fn coefficient(&self, law: Law) -> T {
        self.coefficients[law as usize]
    }

    /// The squares of the speeds at whose zeros a law is not smooth (None without such a law); near a zero a step has
    /// to be short.
    #[inline(always)]
    fn roots(&self, seen: &Kinematics<T>, paced: bool) -> [Option<T>; 3] {
        let rolling = seen.rolling();
        [
            self.has_root(Speed::Spin).then(|| seen.spin * seen.spin),
            (self.has_root(Speed::Rolling) && seen.only.is_none() && !paced)
                .then(|| rolling.mac(rolling, seen.w[1] * seen.w[1])),
            self.has_root(Speed::Whole).then(|| seen.square()),
        ]
    }
}
