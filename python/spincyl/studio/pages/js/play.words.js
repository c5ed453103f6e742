// The words of the page in all its languages. In the scripts a word is W("a word {0}", 5), and N("a word") is one that W takes later;
// the page has numbers in their place, and a table of the words for each language.

const TABLE = JSON.parse($("words").textContent);
let language = "en", chosen = "";
const W = (word, ...given) => (TABLE[language][1][word] ?? word).replace(/\{(\d)\}/g, (_, i) => given[i]);
// elements whose text is a word, and those of the page as it is written in English
const spoken = [];
function worded(element, word, ...given) {
  spoken.push(() => { element.textContent = W(word, ...given); });
  element.textContent = W(word, ...given);
  return element;
}
{
  const number = new Map(TABLE.en[1].map((word, i) => [word, i])), find = text => number.get(text.replace(/\s+/g, " ").trim());
  const walk = document.createTreeWalker(document.body, NodeFilter.SHOW_ELEMENT | NodeFilter.SHOW_TEXT);
  for (let node = walk.nextNode(); node; node = walk.nextNode()) {
    const text = node.data, word = text?.trim() ? find(text) : undefined, here = node;
    if (word !== undefined) {
      const around = here.parentNode, alone = around.childNodes.length === 1;
      spoken.push(() => { if (alone) around.textContent = W(word); else here.data = text.match(/^\s*/)[0] + W(word) + text.match(/\s*$/)[0]; });
    }
    for (const name of ["title", "aria-label"]) {
      const told = node.getAttribute?.(name), known = told ? find(told) : undefined;
      if (known !== undefined) spoken.push(() => here.setAttribute(name, W(known)));
    }
  }
}
function speak(wanted) {
  language = wanted;
  document.documentElement.lang = wanted;
  $("language").value = wanted;
  for (const tell of spoken) tell();
}
for (const [code, [name]] of Object.entries(TABLE)) $("language").add(new Option(name, code));
// that of the address, else of the file, else of the browser; the state of the page has no language
{
  const asked = /[#&]language=(\w+)\b/.exec(location.hash)?.[1];
  if (asked in TABLE) chosen = asked;
  speak(chosen || given.language || (navigator.languages || []).map(x => x.slice(0, 2)).find(x => x in TABLE) || "en");
  delete given.language;
}
