// The text about the body: its behaviour, and the reason for it.

const decimal = (x, d = 2) => Number.isFinite(x) ? x.toFixed(d) : "–", degrees = (x, d = 1) => decimal(x / deg, d) + "°";
// the reduced rate, and the rate in hertz if the size is known
const rated = rate => decimal(rate, 3) + (sized() ? ` (${decimal(hertzOf(rate))} Hz)` : "");
const ENDINGS = ["", N("its face lands on the table"), body => body.fillet === 1 ? N("the other end lands") : N("the other rim lands: it lies on its side"), N("it lifts off"), N("rolling needs more friction than there is"), "", N("no contact force, or more than one, obeys the law of friction"), N("it comes to rest"), N("the computation stops, for the motion changes ever faster"), N("both rims land, and no impulse, or more than one, obeys the law of friction")];
// whether the later motion depends on a disturbance smaller than the rounding of the initial state
const unsure = () => known() && !(head.error < 1e-3);
const ending = () => { const e = ENDINGS[head.ending]; return e === "" ? "" : W(typeof e === "function" ? e(body) : e); };

// inclinations without a steady state: between both lines, or on one side of a single line; a ball has no
// inclination at which it balances
function band() {
  const { theta0, limit } = body, two = Number.isFinite(theta0) && Number.isFinite(limit), line = two ? 0 : Number.isFinite(theta0) ? theta0 : limit;
  if (two) return W("between θ₀ = {0} and θ∞ = {1}", degrees(theta0), degrees(limit));
  return Number.isFinite(line) ? W(s.theta < line ? N("below {0} = {1}") : N("above {0} = {1}"), line === theta0 ? "θ₀" : "θ∞", degrees(line)) : W("here");
}
// text about a free body that leaves the table or lies on both rims; nothing for any other
function aloft() {
  const last = tracked.rows.at(-1)?.[OF_ROW.kind], lies = onBoth(last), rolls = lies && last > FLIES + 2 && (body.circles ? N("Friction stops its slip, and it rolls round in a circle.") : N("Friction stops its slip, and it rolls straight on."));
  if (known() && head.impacts) return [W("Set free, it hops"), [N("it leaves the table and comes down again. Each impact takes energy."), lies && N("At last it lies on its side."), lies && rolls].filter(x => x !== false).map(x => W(x)).join(" ")];
  return lies && [W("It lies on its side"), [N("nothing lifts it off its two rims."), rolls].filter(x => x !== false).map(x => W(x)).join(" ")];
}
// the outcome of a slip, as far as it was computed
function slowed() {
  if (s.contact === "viscous") return W("friction fades with the slip, so that it slips less and less and never rolls.");
  if (known() && head.slipTime < head.lasts) return W("friction slows its rim down until the rim is at rest; then it rolls.");
  return known() && head.ending ? W("friction slows its rim down, but something else comes first.") : W("friction slows its rim down.");
}
function verdict() {
  const ice = s.contact === "smooth", wet = s.contact === "viscous", over = known() && head.ending > 0 && !lossy() && !unsure(), turning = Number.isFinite(s.precession) && !s.w;
  if (s.w && !s.w.some(Boolean)) return [W("Let go at rest"), W("it does not turn, as it would in a steady state.")];
  if (s.w && aloft()) return aloft();
  if (s.slope) return [W("On a slope of {0}", degrees(s.slope)), W(s.w ? N("it starts as it was set free.") : here.code ? N("it starts at rest.") : N("it starts as it spins steadily on a level table.")) + " " + W("The map and the other inclinations are those of a level table.")];
  if (s.w) return s.w[3] || s.w[4] ? [W("Set free, slipping"), slowed()] : [W("Set free"), W("it does not start in a steady state.")];
  if (isTube() && s.ell > 0 && s.theta > Math.PI / 2 - 1e-9) return [W("On its side"), W("lying on both rims, every tube has the rate 1.")];
  if (s.theta > steep() - 1e-9 && known() && !lasting()) return [W("On both ends"), W("it lies on the table.")];
  switch (here.region) {
    case 1: return [W("Forbidden: no rate holds it here"), W("{0} its weight and its spin tip it the same way. Let go at rest, it falls.", band())];
    case 2: return [W("Too close to decide"), W("at the edge of the forbidden band the rate is 0 or infinite. Let go at rest, it falls.")];
    case 0: return [W("No steady state"), turning ? W("no body rolls on a circle with this precession at this inclination.") : W("no steady state of this body is known here. Let go at rest, it falls.")];
  }
  if (turning) return [W("A circle of radius {0} R", decimal(here.circle)), W(here.rolling > 0 ? N("its centre goes round it, and rolling is stable: pushed, it nods.") : N("its centre goes round it, and rolling is unstable: the least push grows."))];
  switch (here.region) {
    case 7: return [W("Stable"), lossy() ? W("a push makes it nod, on ice as on rubber; its losses bring it down.") : over ? W("a small push makes it nod, on ice as on rubber; this one is too much.") : wet ? W("pushed, it nods, on ice as on rubber; here it slips as it nods, and loses energy.") : W("pushed, it nods and goes on, on ice as on rubber.")];
    case 5: return [W("Stable because it rolls: on ice it falls"), ice ? W("now it is on ice, where the least push grows.") : over ? W("but this push is too much.") : wet ? W("a wet table is between the two: its rim slips, but not freely.") : W("the friction that keeps its rim from slipping turns it back.")];
    case 6: return [W("Stable on ice only"), ice ? W("pushed, it nods and goes on; on rubber the least push would grow.") : wet ? W("a wet table is between ice and rubber, where the least push grows.") : W("rolling, the least push grows; on ice it would nod and go on.")];
    default: return [W("Unstable"), W("the least push grows, on ice as on rubber.")];
  }
}
function details() {
  const told = [];
  if (!known()) return told;
  const d = head.high - head.low < 0.02 ? 3 : 1;
  let least = Infinity, need = 0;
  for (const row of tracked.rows) { if (row[OF_ROW.kind] < FLIES) least = Math.min(least, row[OF_ROW.normal]); need = Math.max(need, row[OF_ROW.demand]); }
  if (s.slope && lasting()) {
    const [from, to] = [0, -1].map(k => placed(tracked.rows.at(k)).centre), [down, across] = [0, 1].map(k => to[k] - from[k]);
    told.push(W(down < 0 ? N("its centre comes {0} R up") : N("its centre comes {0} R down"), decimal(Math.abs(down))), W(across < 0 ? N("{0} R to the right") : N("{0} R to the left"), decimal(Math.abs(across))));
  } else if (!here.code && !s.w) {
    if (Number.isFinite(here.rate)) told.push(W("rate {0}", rated(here.rate)));
    else if (sized()) told.push(W("goes round {0} times a second", decimal(hertz(here.precession))));
    if (here.symbols < 1e3) told.push(W("{0} still symbols", decimal(here.symbols, 2)));
  }
  if (Number.isFinite(head.period) && head.high - head.low > 1e-4 && !(head.ending && head.ends < head.period)) told.push(W("nods between {0} and {1}, once in {2}", degrees(head.low, d), degrees(head.high, d), timed(head.period)));
  if (s.contact === "rolling" && need > 5e-3 && need < 1e3) told.push(W("needs friction μ ≥ {0}", decimal(need)));
  if (head.slipTime > 0) told.push(W("slips for {0} in all", timed(head.slipTime)));
  if (head.impacts) told.push(W(head.impacts > 1 ? N("{0} impacts take {1} M g R") : N("1 impact takes {1} M g R"), head.impacts, decimal(head.knocked, 3)));
  if (head.lost > 1e-12) told.push(`${W("loses {0} M g R", decimal(head.lost, 3))}${Number.isFinite(s.mass) ? `, ${(head.lost * s.mass * s.gravity * s.radius).toPrecision(3)} J` : ""}`);
  if (least < 0.995 && !head.impacts) told.push(W("normal force at least {0} of its weight", decimal(least)));
  if (head.error > 0 && head.error < 1) told.push(W("error below {0}", head.error.toExponential(0)));
  told.push(sized() ? `R = ${decimal(1e3 * s.radius, 1)} mm` : W("slow motion for R = 1 cm, as its size is not known"));
  return told;
}
function say(on) {
  const [what, why] = body.code ? [W("No such body"), body.why] : head?.code ? [W("No answer"), head.why + " " + W("The body is shown at its start.")] : verdict();
  const at = digits => `t = ${sized() ? timed(head.ends, digits - 1) : decimal(head.ends, digits)}`;
  const ends = !known() ? "" : !lasting() ? " " + W("At the very start {0}. There is no motion to show, so the body stands still.", ending() || W("it ends"))
    : unsure() ? " " + (head.ending ? W("The least push grows until it decides. Here, at about {0}, {1}.", at(1), ending()) : W("The least push grows until it decides: the last part shows one of many possible motions."))
      : head.ending ? " " + W("At {0} {1}.", at(3), ending()) : "";
  const turns = sized() && !here.code && !s.w && !s.slope && here.rate > 0 ? " " + W("It turns {0} times a second.", decimal(hertzOf(here.rate))) : "";
  $("what").textContent = (on ? W("On the line: {0}.", lineName(on)) + " " : "") + what;
  $("because").textContent = why.replace(/^[a-zà-ÿ]/, x => x.toUpperCase()) + turns + ends;
  const wrong = odd.length ? [W("not understood in the address: {0}", odd.join(", "))] : [];
  $("details").textContent = [...wrong, ...details()].map(x => x.replaceAll(" ", "\u00a0").replaceAll("-", "\u2011")).join(" · ");
  const others = ghosts.map(degrees);
  const button = (textContent, title, onclick) => Object.assign(document.createElement("button"), { type: "button", textContent, title, onclick });
  $("others").replaceChildren(...ghosts.map((theta, i) => button(W("also at {0}", others[i]), W("the same rate at another inclination"), () => change({ theta }))));
  // the still symbols of the paper, with one click
  if (known() && !s.w && !s.slope && !without && here.symbols > 1.5 && here.symbols < 40) $("others").append(button(W("see the still symbols"), W("open the shutter for one turn"), () => { $("shutter").value = "1"; $("shutter").onchange(); }));
  clearTimeout(say.later); // screen readers get the text when the user pauses
  say.later = setTimeout(() => { $("said").textContent = `${$("what").textContent}. ${$("because").textContent} ${W("aspect ratio {0}, inclination {1}", decimal(s.ell), degrees(s.theta))}. ${$("details").textContent}`; }, 700);
}
