// Figures that compute: where the browser allows it, the page in which the core runs takes the place of a picture when that
// comes into view, and links in the prose set what the nearest figure of their section shows.

(() => {
  // a function that makes a vector of bytes: what the core needs
  const SIMD = [0, 97, 115, 109, 1, 0, 0, 0, 1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0, 10, 8, 1, 6, 0, 65, 0, 253, 15, 11];
  const able = () => {
    try {
      new WebAssembly.Module(Uint8Array.from(SIMD));
      return !!document.createElement("canvas").getContext("webgl2");
    } catch { return false; }
  };
  const figures = [...document.querySelectorAll("figure.live")];
  if (!figures.length || !able()) return;
  document.documentElement.classList.add("able");

  const frameOf = figure => figure.querySelector("iframe");
  // the page in a figure, in the state that its address tells; it is opened if it is not there yet
  function show(figure, src) {
    const there = frameOf(figure);
    if (there) return there.contentWindow.location.replace(src);
    const title = figure.querySelector("figcaption").firstChild.textContent.trim();
    figure.querySelector(".picture").after(Object.assign(document.createElement("iframe"), { src, title, allowFullscreen: true }));
  }
  const near = new IntersectionObserver(all => {
    for (const { isIntersecting, target } of all) if (isIntersecting) {
      near.unobserve(target);
      if (!frameOf(target)) show(target, target.dataset.live);
    }
  }, { rootMargin: "200px" });
  figures.forEach(figure => near.observe(figure));
  // the picture stays until the page says that it works, by asking for a state
  addEventListener("message", e => {
    const figure = e.data?.spincyl !== undefined && figures.find(one => frameOf(one)?.contentWindow === e.source);
    figure?.classList.add("alive");
  });

  function figureOf(link) {
    for (let part = link.closest("section"); part; part = part.parentElement.closest("section")) {
      const found = [...part.querySelectorAll("figure.live")], { y } = link.getBoundingClientRect();
      const away = figure => { const { top, bottom } = figure.getBoundingClientRect(); return Math.max(top - y, y - bottom); };
      if (found.length) return found.reduce((a, b) => away(b) < away(a) ? b : a);
    }
    return null;
  }
  addEventListener("click", e => {
    const link = e.target.closest("a.live"), figure = link && figureOf(link);
    if (!figure || e.ctrlKey || e.metaKey || e.shiftKey) return;
    e.preventDefault();
    const [part] = /^.*#figure=\w+/.exec(figure.dataset.live);
    show(figure, `${new URL(part, document.baseURI)}&${link.hash.slice(1)}`);
    figure.scrollIntoView({ block: "nearest", behavior: matchMedia("(prefers-reduced-motion: reduce)").matches ? "auto" : "smooth" });
  });
})();
