//! Integers of 4096 bits, and the exact number of zeros of a polynomial with such coefficients, by the rule
//! of Descartes.

const LIMBS: usize = 64;

/// An integer in two's complement, lowest limb first. It must not grow beyond 4000 bits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Big([u64; LIMBS]);

impl Big {
    pub const ZERO: Self = Self([0; LIMBS]);

    /// The product x 2^shift, which has to be an integer.
    pub fn scaled(x: f64, shift: u32) -> Self {
        let bits = x.to_bits();
        let (exponent, fraction) = ((bits >> 52 & 0x7FF) as i64, bits & ((1 << 52) - 1));
        let (mantissa, exponent) =
            if exponent == 0 { (fraction, -1074) } else { (fraction | 1 << 52, exponent - 1075) };
        let up = exponent + i64::from(shift);
        let mut big = Self::ZERO;
        if up < 0 {
            assert!(
                mantissa.trailing_zeros() as i64 >= -up || mantissa == 0,
                "{x} has digits below 2^-{shift}"
            );
            big.0[0] = if mantissa == 0 { 0 } else { mantissa >> -up };
        } else {
            big.0[0] = mantissa;
            big = big.up(up as usize);
        }
        if x < 0.0 { big.negative() } else { big }
    }

    pub fn plus(&self, other: &Self) -> Self {
        let (mut sum, mut carry) = (Self::ZERO, false);
        for i in 0..LIMBS {
            let (x, a) = self.0[i].overflowing_add(other.0[i]);
            let (x, b) = x.overflowing_add(carry.into());
            (sum.0[i], carry) = (x, a || b);
        }
        sum
    }

    pub fn negative(&self) -> Self {
        let mut one = Self::ZERO;
        one.0[0] = 1;
        Self(self.0.map(|x| !x)).plus(&one)
    }

    pub fn times(&self, other: &Self) -> Self {
        let mut product = Self::ZERO;
        for i in 0..LIMBS {
            if self.0[i] == 0 {
                continue;
            }
            let mut carry = 0u128;
            for j in 0..LIMBS - i {
                let sum =
                    u128::from(self.0[i]) * u128::from(other.0[j]) + u128::from(product.0[i + j]) + carry;
                product.0[i + j] = sum as u64;
                carry = sum >> 64;
            }
        }
        product
    }

    /// Returns this integer times 2^by.
    pub fn up(&self, by: usize) -> Self {
        let (limbs, bits) = (by / 64, by % 64);
        let mut up = Self::ZERO;
        for i in (limbs..LIMBS).rev() {
            up.0[i] = self.0[i - limbs] << bits;
            if bits > 0 && i > limbs {
                up.0[i] |= self.0[i - limbs - 1] >> (64 - bits);
            }
        }
        up
    }

    /// The sign of this integer: -1, 0 or 1.
    pub fn sign(&self) -> i32 {
        if *self == Self::ZERO {
            0
        } else if self.0[LIMBS - 1] >> 63 == 1 {
            -1
        } else {
            1
        }
    }
}

/// The coefficients of a polynomial, lowest power first.
pub type Polynomial = Vec<Big>;

pub fn sum(a: &[Big], b: &[Big]) -> Polynomial {
    let at = |x: &[Big], i: usize| x.get(i).copied().unwrap_or(Big::ZERO);
    (0..a.len().max(b.len())).map(|i| at(a, i).plus(&at(b, i))).collect()
}

pub fn product(a: &[Big], b: &[Big]) -> Polynomial {
    let mut c = vec![Big::ZERO; a.len() + b.len() - 1];
    for (i, x) in a.iter().enumerate() {
        for (j, y) in b.iter().enumerate() {
            c[i + j] = c[i + j].plus(&x.times(y));
        }
    }
    c
}

pub fn negative(a: &[Big]) -> Polynomial {
    a.iter().map(Big::negative).collect()
}

/// The coefficients of p(t + 1).
fn shifted(p: &[Big]) -> Polynomial {
    let mut p = p.to_vec();
    for i in 0..p.len() {
        for j in (i..p.len() - 1).rev() {
            p[j] = p[j].plus(&p[j + 1]);
        }
    }
    p
}

fn reversed(p: &[Big]) -> Polynomial {
    p.iter().rev().copied().collect()
}

/// The number of changes of sign among the coefficients.
fn changes(p: &[Big]) -> usize {
    let signs: Vec<i32> = p.iter().map(Big::sign).filter(|s| *s != 0).collect();
    signs.windows(2).filter(|s| s[0] != s[1]).count()
}

/// The number of zeros of a polynomial in (0, 1) if they are simple; None if two of them agree to more than
/// 200 bits.
///
/// By the rule of Descartes it is the number of changes of sign of (t + 1)^n p(1/(t + 1)), or less by an even number.
/// Therefore 0 or 1 change decides; otherwise the interval is halved (Vincent, Collins and Akritas).
pub fn zeros_in_unit_interval(p: &[Big]) -> Option<usize> {
    // zeros at 0 are outside
    let low = p.iter().position(|x| x.sign() != 0)?;
    count(&p[low..], 200)
}

fn count(p: &[Big], depth: u32) -> Option<usize> {
    match changes(&shifted(&reversed(p))) {
        few @ (0 | 1) => Some(few),
        _ if depth == 0 => None,
        _ => {
            // 2^n p(t/2) is the polynomial on the lower half; its shift by 1 is that on the upper half
            let n = p.len() - 1;
            let lower: Polynomial = p.iter().enumerate().map(|(i, x)| x.up(n - i)).collect();
            let mut upper = shifted(&lower);
            let middle = usize::from(upper[0].sign() == 0);
            while upper[0].sign() == 0 {
                upper.remove(0);
            }
            Some(count(&lower, depth - 1)? + middle + count(&upper, depth - 1)?)
        }
    }
}

/// The number of zeros of a polynomial in (1, infinity) if they are simple; None if two of them agree to more than
/// 200 bits.
pub fn zeros_beyond_one(p: &[Big]) -> Option<usize> {
    let top = p.iter().rposition(|x| x.sign() != 0)?;
    zeros_in_unit_interval(&reversed(&p[..=top]))
}

#[test]
fn zeros_are_counted_as_they_are_planted() {
    // products of (q t - p)
    let of = |roots: &[(f64, f64)]| {
        roots.iter().fold(vec![Big::scaled(1.0, 0)], |all, (p, q)| {
            product(&all, &[Big::scaled(-p, 0), Big::scaled(*q, 0)])
        })
    };
    assert_eq!(
        zeros_in_unit_interval(&of(&[(1.0, 2.0), (1.0, 3.0), (3.0, 4.0), (5.0, 4.0), (0.0, 1.0)])),
        Some(3)
    );
    assert_eq!(
        zeros_beyond_one(&of(&[(1.0, 2.0), (5.0, 4.0), (7.0, 1.0), (1.0, 1.0), (-2.0, 1.0)])),
        Some(2)
    );
    // two zeros at a distance of 2^-60
    let near = 2f64.powi(60);
    let close = product(
        &of(&[(1.0, 2.0)]),
        &[Big::scaled(-near, 0).plus(&Big::scaled(-2.0, 0)), Big::scaled(2.0 * near, 0)],
    );
    assert_eq!(zeros_in_unit_interval(&close), Some(2));
    // 1 + t^2, and a double zero
    assert_eq!(zeros_in_unit_interval(&[Big::scaled(1.0, 0), Big::ZERO, Big::scaled(1.0, 0)]), Some(0));
    assert_eq!(zeros_in_unit_interval(&of(&[(1.0, 3.0), (1.0, 3.0)])), None);
    assert_eq!(Big::scaled(-0.75, 2), Big::scaled(3.0, 0).negative());
    assert!(Big::scaled(1e300, 0).times(&Big::scaled(-1e300, 0)).sign() < 0);
}
