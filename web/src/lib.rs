//! The interface of the live page to the core: a call takes numbers, returns a code and fills a flat buffer.
//!
//! ```text
//! code = call(numbers)     new Float64Array(memory.buffer, out(), len())     made anew after every call
//! ```
//! No call takes a pointer, so that only the attribute that names an export is unsafe. Every error is a code with a
//! meaning ([`Refusal`]); every number is the result of a public function of `spincyl`. The module `exports` defines
//! the WebAssembly calls; as a Rust library the crate has [`Desk`], with which a native program makes the same calls.
//!
//! `tests/test_web.py` compares a page with a native program: codes are equal, and motions agree within their
//! estimated errors.

mod body;
#[cfg(target_arch = "wasm32")]
mod exports;
mod hand;
mod map;
mod motion;
mod refusal;
mod steady;
#[cfg(feature = "friction")]
mod stone;
#[cfg(feature = "friction")]
mod walk;

use motion::Kept;
pub use refusal::Refusal;
use spincyl::Body;
use spincyl::loss::Losses;

/// The current body, its losses, its table and its motion, and the last answer.
#[derive(Debug, Default)]
pub struct Desk {
    /// The numbers of the last answer.
    pub out: Vec<f64>,
    /// The codes of the last map.
    pub codes: Vec<u8>,
    /// The name and the accepted range of the last number that was out of range, on two lines.
    pub words: String,
    body: Option<Body>,
    losses: Losses,
    /// The slope of the table, and the initial direction phi of the lean from downhill, in radians.
    slope: [f64; 2],
    motion: Option<Kept>,
}

/// The result of a call: its numbers have been written, or the reason why there are none.
pub type Answer = Result<(), Refusal>;

impl Desk {
    /// Clears the last answer, makes the call `question`, and returns its code (0 for success).
    pub fn ask(&mut self, question: impl FnOnce(&mut Self) -> Answer) -> u32 {
        self.out.clear();
        self.words.clear();
        match question(self) {
            Ok(()) => 0,
            Err(refusal) => {
                self.out.clear();
                refusal.tell(&mut self.out, &mut self.words)
            }
        }
    }

    fn set_body(&self) -> Result<Body, Refusal> {
        self.body.ok_or(Refusal::Nothing)
    }
}

/// Converts a count that is given as a double, from 1 to `most`; an error if it is out of range.
fn count(name: &'static str, given: f64, most: usize) -> Result<usize, Refusal> {
    if given >= 1.0 && given <= most as f64 {
        Ok(given as usize)
    } else {
        Err(Refusal::Range { name, value: given, expected: "a whole number, at least 1 and not too large" })
    }
}
