// Day or night: the theme of the notebook around the page, if it can be read or is sent; else the browser's
// preference.

const dusk = { matches: false, onchange: null };
{
  const prefers = matchMedia("(prefers-color-scheme: dark)");
  let around = null;
  const set = () => {
    const was = dusk.matches;
    dusk.matches = around ?? prefers.matches;
    document.documentElement.toggleAttribute("data-night", dusk.matches);
    if (was !== dusk.matches) dusk.onchange?.();
  };
  prefers.onchange = set;
  if (window.parent !== window) {
    try {
      const { body } = window.parent.document, ask = () => { around = { false: true, true: false }[body.dataset.jpThemeLight] ?? null; set(); };
      new MutationObserver(ask).observe(body, { attributes: true });
      ask();
    } catch { /* a page of another origin cannot be read */ }
    addEventListener("message", e => { if (e.source === window.parent && typeof e.data?.spincylNight === "boolean") { around = e.data.spincylNight; set(); } });
  }
  set();
}
