"""Words of the picture that lie over buttons or text beside it."""

#: Names of a word and the panel under it, or "".
OVER_PANELS = """(() => {
  const panels = [...document.querySelectorAll(
    '.view-stage :is(.view-bar, .legend, .cube, .force-legend, .scale-bar, .badges, .picked, ' +
    '.view-banner)')];
  const meet = (a, b) => a.left < b.right - 1 && b.left < a.right - 1 &&
    a.top < b.bottom - 1 && b.top < a.bottom - 1;
  for (const word of document.querySelectorAll('.view-label:not([hidden], .crowded)'))
    for (const panel of panels)
      if (meet(word.getBoundingClientRect(), panel.getBoundingClientRect()))
        return `the word "${word.textContent}" lies over ${panel.className}`;
  return '';
})()"""
