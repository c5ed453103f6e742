// The sound, after `studio/sound.py`: noise that rings, loudest when the contact point passes the eye, and impacts, with the same
// compression of levels. Nothing sounds until it is asked for. Each page has `heardAt`, the azimuth of a contact point and its speed
// along the body for each motion, and `hits`, the times and the impulses of impacts.

const RESONANCES = [[1150, 0.03, 1], [2710, 0.02, 0.6], [4890, 0.012, 0.35]], STROKE = 0.4, LOUD = 0.25;
// what is heard is scheduled for this many seconds, in steps
const AHEAD = 0.15, MOMENT = 1 / 300;
const beats = azimuth => Math.exp(2 * (Math.cos(azimuth - eye.azimuth) - 1)), BEATS = 0.3085; // their mean
let audio = null;
function hear() {
  if (audio) { audio.close(); audio = null; }
  else {
    audio = new AudioContext();
    const rate = audio.sampleRate, buffer = seconds => new AudioBuffer({ length: Math.round(seconds * rate), sampleRate: rate }), [ring, noise] = [buffer(0.25), buffer(2)], x = ring.getChannelData(0);
    for (let i = 0; i < x.length; i++) for (const [hertz, decay, size] of RESONANCES) x[i] += size * Math.exp(-i / rate / decay) * Math.sin(2 * Math.PI * hertz * i / rate);
    noise.getChannelData(0).forEach((_, i, all) => { all[i] = Math.sqrt(3) * (2 * Math.random() - 1); });
    const whole = x.reduce((sum, y) => sum + y * y, 0), source = new AudioBufferSourceNode(audio, { buffer: noise, loop: true });
    Object.assign(audio, { ring, peak: x.reduce((most, y) => Math.max(most, Math.abs(y)), 0), power: whole / rate, at: 0, t: 0, loud: new GainNode(audio, { gain: 0 }), out: new GainNode(audio) });
    audio.full = LOUD / Math.sqrt(whole);
    source.connect(new ConvolverNode(audio, { buffer: ring, disableNormalization: true })).connect(audio.loud).connect(audio.out).connect(audio.destination);
    source.start();
  }
  $("hear").ariaPressed = !!audio;
  show();
}
// the gain of the noise at a time, with the whirr of all motions; a beat faster than the steps has its mean
function whirr(t, per, most) {
  const power = heardAt(t).map(([azimuth, speed], i) => {
    const step = Math.abs(azimuth - (audio.was?.[i] ?? azimuth)), shown = Math.min(1, Math.max(0, 2 - step * 2 / Math.PI));
    (audio.was ??= [])[i] = azimuth;
    const level = Math.sqrt(Math.min(speed, 2 * Math.PI * RESONANCES[0][0] / per) * audio.power) / most;
    return level * (BEATS + shown * (beats(azimuth) - BEATS)) ** 2;
  });
  return audio.full * Math.sqrt(power.reduce((a, b) => a + b, 0));
}
function strike(level, at) {
  const source = new AudioBufferSourceNode(audio, { buffer: audio.ring });
  source.connect(new GainNode(audio, { gain: LOUD * Math.sqrt(level) / audio.peak })).connect(audio.out);
  source.start(at);
}
// in each frame: schedules what is heard next, with `per` units of the motion in a second
function sounded(now, per, on) {
  if (!audio) return;
  const { gain } = audio.loud, c = audio.currentTime;
  if (!on) {
    if (audio.at) { gain.cancelScheduledValues(c); gain.setTargetAtTime(0, c, 0.01); }
    audio.at = 0;
    return;
  }
  const [speed, impulse] = loudest(), most = Math.max(Math.sqrt(speed * audio.power), STROKE * audio.peak * impulse, 1e-9);
  if (!(audio.at > c) || Math.abs(audio.t - now - (audio.at - c) * per) > 0.1 * per) {
    gain.cancelScheduledValues(c);
    gain.setValueAtTime(gain.value, c);
    Object.assign(audio, { at: c, t: now, was: null });
  }
  while (audio.at < c + AHEAD) {
    const t = audio.t + MOMENT * per;
    gain.linearRampToValueAtTime(whirr(t, per, most), audio.at + MOMENT);
    for (const [at, size] of hits()) if (at > audio.t && at <= t || at === audio.t && at === 0) strike(STROKE * audio.peak * size / most, audio.at + MOMENT);
    audio.t = t;
    audio.at += MOMENT;
  }
}
$("hear").onclick = hear;
