// The text about the body: its behaviour, and the reason for it.

const decimal = (x, d = 2) => Number.isFinite(x) ? x.toFixed(d) : "–", degrees = (x, d = 1) => decimal(x / deg, d) + "°";
// the reduced rate, and the rate in hertz if the size is known
const rated = rate => decimal(rate, 3) + (sized() ? ` (${decimal(hertzOf(rate))} Hz)` : "");
const ENDINGS = ["", "its face lands on the table", body => body.fillet === 1 ? "the other end lands" : "the other rim lands: it lies on its side", "it lifts off", "rolling needs more friction than there is", "", "no contact force, or more than one, obeys the law of friction", "it comes to rest", "the computation stops, for the motion changes ever faster", "both rims land, and no impulse, or more than one, obeys the law of friction"];
// whether the later motion depends on a disturbance smaller than the rounding of the initial state
const unsure = () => known() && !(head.error < 1e-3);
const ending = () => { const e = ENDINGS[head.ending]; return typeof e === "function" ? e(body) : e; };

// inclinations without a steady state: between both lines, or on one side of a single line; a ball has no
// inclination at which it balances
function band() {
  const { theta0, limit } = body, two = Number.isFinite(theta0) && Number.isFinite(limit), line = two ? 0 : Number.isFinite(theta0) ? theta0 : limit;
  if (two) return `between θ₀ = ${degrees(theta0)} and θ∞ = ${degrees(limit)}`;
  return Number.isFinite(line) ? `${s.theta < line ? "below" : "above"} ${line === theta0 ? "θ₀" : "θ∞"} = ${degrees(line)}` : "here";
}
// text about a free body that leaves the table or lies on both rims; nothing for any other
function aloft() {
  const last = tracked.rows.at(-1)?.[OF_ROW.kind], lies = onBoth(last), rolls = lies && last > FLIES + 2 && (body.circles ? "rolls round in a circle" : "rolls straight on");
  if (known() && head.impacts) return ["Set free, it hops", `it leaves the table and comes down again${lies ? `; at last it lies on its side${rolls ? ", and " + rolls : ""}` : ""}. Each impact takes energy.`];
  return lies && ["It lies on its side", `nothing lifts it off its two rims${rolls ? ": friction stops their slip, and it " + rolls : ""}.`];
}
// the outcome of a slip, as far as it was computed
function slowed() {
  if (s.contact === "viscous") return "friction fades with the slip, so that it slips less and less and never rolls.";
  if (known() && head.slipTime < head.lasts) return "friction slows its rim down until the rim is at rest; then it rolls.";
  return known() && head.ending ? "friction slows its rim down, but something else comes first." : "friction slows its rim down.";
}
function verdict() {
  const ice = s.contact === "smooth", wet = s.contact === "viscous", over = known() && head.ending > 0 && !lossy() && !unsure(), turning = Number.isFinite(s.precession) && !s.w;
  if (s.w && !s.w.some(Boolean)) return ["Let go at rest", "it does not turn, as it would in a steady state."];
  if (s.w && aloft()) return aloft();
  if (s.slope) return [`On a slope of ${degrees(s.slope)}`, `it starts ${s.w ? "as it was set free" : here.code ? "at rest" : "as it spins steadily on a level table"}. The map and the other inclinations are those of a level table.`];
  if (s.w) return s.w[3] || s.w[4] ? ["Set free, slipping", slowed()] : ["Set free", "it does not start in a steady state."];
  if (isTube() && s.ell > 0 && s.theta > Math.PI / 2 - 1e-9) return ["On its side", "lying on both rims, every tube has the rate 1."];
  if (s.theta > steep() - 1e-9 && known() && !lasting()) return ["On both ends", "it lies on the table."];
  switch (here.region) {
    case 1: return ["Forbidden: no rate holds it here", `${band()} its weight and its spin tip it the same way. Let go at rest, it falls.`];
    case 2: return ["Too close to decide", "at the edge of the forbidden band the rate is 0 or infinite. Let go at rest, it falls."];
    case 0: return ["No steady state", turning ? "no body rolls on a circle with this precession at this inclination." : "no steady state of this body is known here. Let go at rest, it falls."];
  }
  if (turning) return [`A circle of radius ${decimal(here.circle)} R`, `its centre goes round it, and rolling is ${here.rolling > 0 ? "stable: pushed, it nods" : "unstable: the least push grows"}.`];
  switch (here.region) {
    case 7: return ["Stable", lossy() ? "a push makes it nod, on ice as on rubber; its losses bring it down." : over ? "a small push makes it nod, on ice as on rubber; this one is too much." : wet ? "pushed, it nods, on ice as on rubber; here it slips as it nods, and loses energy." : "pushed, it nods and goes on, on ice as on rubber."];
    case 5: return ["Stable because it rolls: on ice it falls", ice ? "now it is on ice, where the least push grows." : over ? "but this push is too much." : wet ? "a wet table is between the two: its rim slips, but not freely." : "the friction that keeps its rim from slipping turns it back."];
    case 6: return ["Stable on ice only", ice ? "pushed, it nods and goes on; on rubber the least push would grow." : wet ? "a wet table is between ice and rubber, where the least push grows." : "rolling, the least push grows; on ice it would nod and go on."];
    default: return ["Unstable", "the least push grows, on ice as on rubber."];
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
    told.push(`its centre comes ${decimal(Math.abs(down))} R ${down < 0 ? "up" : "down"} and ${decimal(Math.abs(across))} R to the ${across < 0 ? "right" : "left"}`);
  } else if (!here.code && !s.w) {
    if (Number.isFinite(here.rate)) told.push(`rate ${rated(here.rate)}`);
    else if (sized()) told.push(`goes round ${decimal(hertz(here.precession))} times a second`);
    if (here.symbols < 1e3) told.push(`${decimal(here.symbols, 2)} still symbols`);
  }
  if (Number.isFinite(head.period) && head.high - head.low > 1e-4 && !(head.ending && head.ends < head.period)) told.push(`nods between ${degrees(head.low, d)} and ${degrees(head.high, d)}, once in ${timed(head.period)}`);
  if (s.contact === "rolling" && need > 5e-3 && need < 1e3) told.push(`needs friction μ ≥ ${decimal(need)}`);
  if (head.slipTime > 0) told.push(`slips for ${timed(head.slipTime)} in all`);
  if (head.impacts) told.push(`${head.impacts} impact${head.impacts > 1 ? "s" : ""} take${head.impacts > 1 ? "" : "s"} ${decimal(head.knocked, 3)} M g R`);
  if (head.lost > 1e-12) told.push(`loses ${decimal(head.lost, 3)} M g R${Number.isFinite(s.mass) ? `, ${(head.lost * s.mass * s.gravity * s.radius).toPrecision(3)} J` : ""}`);
  if (least < 0.995 && !head.impacts) told.push(`normal force at least ${decimal(least)} of its weight`);
  if (head.error > 0 && head.error < 1) told.push(`error below ${head.error.toExponential(0)}`);
  told.push(sized() ? `R = ${decimal(1e3 * s.radius, 1)} mm` : "slow motion for R = 1 cm, as its size is not known");
  return told;
}
function say(on) {
  const [what, why] = body.code ? ["No such body", body.why] : head?.code ? ["No answer", head.why + " The body is shown at its start."] : verdict();
  const at = digits => `t = ${sized() ? timed(head.ends, digits - 1) : decimal(head.ends, digits)}`;
  const grown = " The least push grows until it decides", ends = !known() ? "" : !lasting() ? ` At the very start ${ending() || "it ends"}. There is no motion to show, so the body stands still.`
    : unsure() ? grown + (head.ending ? `. Here, at about ${at(1)}, ${ending()}.` : ": the last part shows one of many possible motions.")
      : head.ending ? ` At ${at(3)} ${ending()}.` : "";
  const turns = sized() && !here.code && !s.w && !s.slope && here.rate > 0 ? ` It turns ${decimal(hertzOf(here.rate))} times a second.` : "";
  $("what").textContent = (on ? `On the ${on === "fold" || on === "ridge" ? on : "line " + on}. ` : "") + what;
  $("because").textContent = why.charAt(0).toUpperCase() + why.slice(1) + turns + ends;
  const wrong = odd.length ? [`not understood in the address: ${odd.join(", ")}`] : [];
  $("details").textContent = [...wrong, ...details()].map(x => x.replaceAll(" ", "\u00a0").replaceAll("-", "\u2011")).join(" · ");
  const others = ghosts.map(degrees);
  const button = (textContent, title, onclick) => Object.assign(document.createElement("button"), { type: "button", textContent, title, onclick });
  $("others").replaceChildren(...ghosts.map((theta, i) => button(`also at ${others[i]}`, "the same rate at another inclination", () => change({ theta }))));
  // the still symbols of the paper, with one click
  if (known() && !s.w && !s.slope && !without && here.symbols > 1.5 && here.symbols < 40) $("others").append(button("see the still symbols", "open the shutter for one turn", () => { $("shutter").value = "1"; $("shutter").onchange(); }));
  clearTimeout(say.later); // screen readers get the text when the user pauses
  say.later = setTimeout(() => { $("said").textContent = `${$("what").textContent}. ${$("because").textContent} Aspect ratio ${decimal(s.ell)}, inclination ${degrees(s.theta)}. ${$("details").textContent}`; }, 700);
}
