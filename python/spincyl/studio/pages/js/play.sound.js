// The sound of the whirr, after `studio/sound.py`: noise through a few resonances, loudest when the contact
// passes the listener.

let audio = null;
const RESONANCES = [[1150, 0.03, 1], [2710, 0.02, 0.6], [4890, 0.012, 0.35]];
function hear() {
  if (audio) { audio.close(); audio = null; $("hear").ariaPressed = false; return; }
  audio = new AudioContext();
  const noise = new AudioBuffer({ length: 2 * audio.sampleRate, sampleRate: audio.sampleRate }), values = noise.getChannelData(0);
  for (let i = 0; i < values.length; i++) values[i] = 2 * Math.random() - 1;
  const source = new AudioBufferSourceNode(audio, { buffer: noise, loop: true });
  audio.loud = new GainNode(audio, { gain: 0 });
  for (const [frequency, decay, gain] of RESONANCES) source.connect(new BiquadFilterNode(audio, { type: "bandpass", frequency, Q: Math.PI * frequency * decay })).connect(new GainNode(audio, { gain: 6 * gain })).connect(audio.loud);
  audio.loud.connect(audio.destination);
  source.start();
  $("hear").ariaPressed = true;
  show();
}
// louder with the speed of the contact along the body, and when the contact passes the listener; none in the air
function heard(p, row) {
  if (!audio) return;
  const slides = Math.abs(row[4] - row[2] / Math.tan(row[1])) * (1 - body.fillet + body.fillet * Math.sin(row[1]));
  const loud = playing && !live.over && row[OF_ROW.kind] !== FLIES ? Math.sqrt(Math.min(9, slides)) / 3 * Math.exp(2 * (Math.cos(p.phi + 1.1) - 1)) : 0;
  audio.loud.gain.setTargetAtTime(loud, audio.currentTime, 0.012);
}
$("hear").onclick = hear;
