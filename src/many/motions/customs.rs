//! Many motions under user-defined laws, each computed alone.

use super::columns::TimedOutput;
use super::{Job, MotionBlock, MotionOutput, MotionStarts, RowBlock, blocks};
use crate::error::{Error, spare};
use crate::laws::custom::Custom;
use crate::many::threads::share_with_large_stacks;
use crate::methods::beat::Beat;
use crate::motions::custom::{check_options, followed};
use std::sync::OnceLock;

/// Number of motions under user-defined laws in a block.
const CUSTOM_MOTIONS_PER_BLOCK: usize = 16;

/// The user-defined laws of many motions.
pub(crate) enum CustomLaws<'a> {
    /// Laws that only the calling thread may use, such as functions of Python.
    ThisThread(Custom<'a>),
    /// Laws that any thread may use.
    AnyThread(&'a (dyn Fn() -> Custom<'a> + Sync)),
}

/// Computes all motions under user-defined laws, as [`roll_among`](super::roll_among) does without such laws. The
/// errors are those of [`custom::roll_with`](crate::custom::roll_with) that a law causes, or an option that is the same
/// for all motions.
pub(crate) fn roll_custom(
    starts: &MotionStarts<'_>,
    job: &Job<'_>,
    out: MotionOutput<'_>,
    (laws, threads): (&CustomLaws<'_>, (usize, bool)),
    go_on: &mut dyn FnMut(f64) -> bool,
) -> Result<bool, Error> {
    let (count, times) = (starts.len(), job.times.len());
    assert!(starts.fit(), "expected columns of one length, or single numbers");
    assert!(out.fits(count, times), "an output array does not have the length of the results");
    job.check(true, starts.coefficients.is_some())?;
    let custom = match laws {
        CustomLaws::ThisThread(custom) => *custom,
        CustomLaws::AnyThread(of) => of(),
    };
    check_options(&job.ask, &custom)?;
    spare()?;
    let mut out = TimedOutput { out, times };
    match laws {
        CustomLaws::ThisThread(custom) => {
            let (mut beat, mut all) = (Beat::new(), true);
            let work = MotionBlock { starts, job, first: 0, since: None };
            let mut still = |done: usize| {
                all = all && (!beat.is_due() || go_on(done as f64 / count as f64));
                all
            };
            work.roll_block_with_custom_laws(count, &mut out.out, *custom, &mut still)?;
            Ok(all)
        }
        CustomLaws::AnyThread(of) => {
            let failed = OnceLock::new();
            let mut go_on = |share| failed.get().is_none() && go_on(share);
            let blocks = blocks(out, count, CUSTOM_MOTIONS_PER_BLOCK)?;
            let all = share_with_large_stacks(
                blocks,
                threads,
                &mut go_on,
                |RowBlock { first, count, out }, still| {
                    let (work, mut out) = (MotionBlock { starts, job, first, since: None }, out.out);
                    if let Err(e) = work.roll_block_with_custom_laws(count, &mut out, of(), &mut |_| still())
                    {
                        let _ = failed.set(e);
                    }
                },
            );
            failed.into_inner().map_or(Ok(all), Err)
        }
    }
}

impl MotionBlock<'_> {
    /// Computes the motions of the block; `go_on` is called with the number of motions that are done.
    fn roll_block_with_custom_laws(
        &self,
        count: usize,
        out: &mut MotionOutput<'_>,
        custom: Custom<'_>,
        go_on: &mut dyn FnMut(usize) -> bool,
    ) -> Result<(), Error> {
        let (starts, job, mut checked) = (self.starts, self.job, None);
        for k in 0..count {
            let i = self.first + k;
            let ask = job.ask_of(starts.coefficients(i), starts.losses(i));
            let body = starts.body(i);
            // A law may be checked once for all motions of a body, but it is at fault for whatever it does.
            if let Ok(body) = body
                && checked != Some((body, ask.table.mu()))
            {
                custom.check(&body, ask.table.mu())?;
                checked = Some((body, ask.table.mu()));
            }
            let found = body.and_then(|body| {
                let mut still = || go_on(k);
                let how = (&ask, job.errors);
                Ok((
                    body,
                    followed(&body, &starts.start(i, &body, &ask.table), job.times, how, custom, &mut still)?,
                ))
            });
            if let Err(e @ (Error::Couple { .. } | Error::Coefficient { .. })) = found {
                return Err(e);
            }
            if custom.has_failed() || !go_on(k) {
                return Ok(());
            }
            self.put_result(out, k, found)?;
        }
        Ok(())
    }
}
