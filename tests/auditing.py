"""Audit of pages by axe."""

from pathlib import Path

AXE = Path(__file__).parents[1] / "studio/node_modules/axe-core/axe.min.js"

#: Serious or critical findings of axe, as lines that name the rule and the element.
FOUND = """async () => {
  const run = await axe.run(document, { resultTypes: ["violations"] });
  return run.violations
    .filter((one) => ["serious", "critical"].includes(one.impact))
    .flatMap((one) => one.nodes.map((node) =>
      `${one.impact} ${one.id}: ${node.target.join(" ")} ${node.html.slice(0, 160)} ` +
      (node.any[0]?.message ?? node.all[0]?.message ?? node.none[0]?.message ?? "")));
}"""


class Audit:
    """Collects the findings of one page after the other."""

    def __init__(self, tab):
        self.tab, self.found = tab, {}

    def look(self, where):
        page = self.tab.page
        if not page.evaluate("typeof axe === 'object'"):
            page.evaluate(AXE.read_text(encoding="utf-8"))
        page.mouse.move(2, 400)
        for line in page.evaluate(FOUND):
            self.found.setdefault(line, where)

    def report(self):
        return "\n".join(f"{where}: {line}" for line, where in self.found.items())
