"""Random walks through the studio: legal actions of a user, and invariants after each of them.

An action is drawn from all that the page offers at that moment: its buttons, fields, sliders,
choices and keys, the picture, the window, a second tab, a dropped file, the server. The seed draws
it; the order of work in the page is not the same twice, so that a failure tells all of its actions.
"""

import json
import random
from dataclasses import dataclass, field

from waiting import until
from websockets.sync.client import connect

from voxsoft.studio.protocol.wire import PROTOCOL

#: Seconds until the page is whole again after an action.
PATIENCE = 60.0
SIZES = ((1600, 900), (1024, 700), (960, 600), (1280, 720))
KEYS = (*"1234567fgxml0rc?,.", " ", "Escape", "Escape", "Tab", "ArrowRight", "ArrowLeft")
CHORDS = ("Control+z", "Control+z", "Control+y", "Control+k", "Alt+1", "Alt+2", "Alt+4")
TYPED = (
    "5 mm",
    "2,5 mm",
    "0.75",
    "40",
    "-3 mm",
    "= 2*5 mm",
    "twelve",
    "",
    "1e3 mm",
    "8 kPa",
    "rob",
)
DROPPED = {
    "beam.csv": "s (mm),dz (mm)\n10,-0.3\n25,-1.7\n40,-4.0\n",
    "note.txt": "no design\n",
    "points.csv": "value,load\n0,0\n1,2\n",
}
# Elements that a user can press or change now. Those that leave the document for another one, or
# ask the system for a file, end the walk's own document and are not of it.
OFFERED = """((kinds) => {
  const away = '[data-testid=start], [data-testid=templates], [data-testid^=template-], '
    + '[data-testid^=robot-], [data-testid=open], input[type=file], [data-testid=take], a[href]';
  const words = /open|template|new robot|choose|browse|tutorial|restore|delete|full ?screen/i;
  const offered = [];
  for (const one of document.querySelectorAll(kinds)) {
    if (one.disabled || !one.checkVisibility() || one.closest(away)) continue;
    const name = one.getAttribute('aria-label') || one.title || one.innerText || '';
    if (words.test(name)) continue;
    const { left, top, width, height } = one.getBoundingClientRect();
    const at = [left + width / 2, top + height / 2];
    if (width < 4 || height < 4 || at[0] < 0 || at[1] < 0) continue;
    if (at[0] > innerWidth || at[1] > innerHeight) continue;
    const top_one = document.elementFromPoint(...at);
    if (!top_one || !(one.contains(top_one) || top_one.contains(one))) continue;
    offered.push({ name: name.slice(0, 60), tag: one.tagName, at });
  }
  return offered;
})"""
# A fault of the page as it stands, or "".
FAULT = """(() => {
  const focused = document.activeElement;
  if (focused === null) return 'the focus is lost';
  if (focused !== document.body && !focused.checkVisibility()) return 'the focus is hidden';
  for (const pane of document.querySelectorAll('.dock [data-testid^=pane-]')) {
    if (!pane.checkVisibility()) continue;
    const drawn = pane.querySelector('canvas, svg, input, button') !== null;
    if (!drawn && pane.innerText.trim().length < 10) return `${pane.dataset.testid} is blank`;
    if (pane.innerText.includes('stopped working')) return `${pane.dataset.testid} has failed`;
  }
  const wide = document.documentElement.scrollWidth;
  if (wide > innerWidth) return `the page is ${wide} pixels wide in a window of ${innerWidth}`;
  return '';
})()"""
# Place and size of the picture, or null.
CANVAS = """(() => {
  const { x, y, width, height } =
    document.querySelector('.viewport canvas')?.getBoundingClientRect() ?? { width: 0 };
  return width > 0 ? { x, y, width, height } : null;
})()"""
DROP = """([name, text]) => {
  const data = new DataTransfer();
  data.items.add(new File([text], name));
  const [x, y] = [innerWidth / 2, innerHeight / 2];
  const target = document.elementFromPoint(x, y) ?? document.body;
  for (const type of ['dragenter', 'dragover', 'drop'])
    target.dispatchEvent(new DragEvent(type, {
      bubbles: true, cancelable: true, dataTransfer: data, clientX: x, clientY: y }));
}"""


def document_of(server):
    """The document as the server has it: its text, revision and way back."""
    url = f"ws://127.0.0.1:{server.port}/ws?token={server.token}"
    with connect(url, origin=f"http://127.0.0.1:{server.port}", max_size=None) as socket:
        socket.send(json.dumps({"t": "hello", "seq": 1, "protocol": PROTOCOL}))
        while True:
            message = socket.recv(timeout=PATIENCE)
            if isinstance(message, str):
                event = json.loads(message)
                if event["t"] == "document":
                    return event


@dataclass
class Walk:
    """A walk of a seed through a tab."""

    tab: object
    server: object
    seed: int
    done: list[str] = field(default_factory=list)

    def __post_init__(self):
        self.random = random.Random(self.seed)
        self.first = document_of(self.server)
        self.tab.page.on("dialog", lambda dialog: dialog.accept())
        self.tab.page.on("filechooser", lambda _: None)

    def go(self, count):
        """Take so many actions, with the invariants after each."""
        usual = (self.press, self.press, self.press, self.press, self.type, self.choose)
        more = (self.slide, self.key, self.key, self.chord, self.drag, self.wheel, self.mode)
        rare = (self.double, self.reload, self.resize, self.second_tab, self.drop)
        for i in range(count):
            pool = self.random.choices((usual, more, rare), (60, 32, 8))[0]
            self.done.append("")
            self.random.choice(pool)()
            self.whole()
            if i % 20 == 19:
                self.agree()

    def say(self, text):
        """Note the action, for the message of a failure."""
        self.done[-1] = text

    def offered(self, kinds):
        found = self.tab.page.evaluate(f"{OFFERED}({json.dumps(kinds)})")
        return self.random.choice(found) if found else None

    # Actions

    def press(self):
        found = self.offered("button, [role=button], [role=option], [role=tab], summary")
        if found:
            self.say(f"press {found['name']!r}")
            self.tab.page.mouse.click(*found["at"])

    def double(self):
        found = self.offered("button")
        if found:
            self.say(f"double click {found['name']!r}")
            before = self.jobs()
            self.tab.page.mouse.dblclick(*found["at"])
            self.tab.page.evaluate("new Promise((then) => requestAnimationFrame(() => then(0)))")
            assert self.jobs() <= before + 1, self.message("one double click started two jobs")

    def type(self):
        found = self.offered("input[type=text], input:not([type]), textarea, input[type=search]")
        if found:
            text = self.random.choice(TYPED)
            end = self.random.choice(("Enter", "Enter", "Tab", "Escape"))
            self.say(f"type {text!r} and {end} into {found['name']!r}")
            self.tab.page.mouse.click(*found["at"])
            self.tab.page.keyboard.press("Control+a")
            self.tab.page.keyboard.type(text)
            self.tab.page.keyboard.press(end)

    def choose(self):
        found = self.offered("select")
        if found:
            self.say(f"choose of {found['name']!r}")
            pick = self.random.random()
            self.tab.page.evaluate(
                """([[x, y], pick]) => {
                  const one = document.elementFromPoint(x, y);
                  if (!(one instanceof HTMLSelectElement)) return;
                  const all = [...one.options].filter((option) => !option.disabled);
                  const option = all[Math.floor(pick * all.length)];
                  if (!option) return;
                  one.value = option.value;
                  one.dispatchEvent(new Event('change', { bubbles: true }));
                }""",
                [found["at"], pick],
            )

    def slide(self):
        found = self.offered("input[type=range]")
        if found:
            self.say(f"slide {found['name']!r}")
            x, y = found["at"]
            page = self.tab.page
            page.mouse.move(x, y)
            page.mouse.down()
            page.mouse.move(x + self.random.randint(-60, 60), y, steps=3)
            page.mouse.up()

    def key(self):
        key = self.random.choice(KEYS)
        self.say(f"key {key!r}")
        self.tab.page.keyboard.press(key)

    def chord(self):
        chord = self.random.choice(CHORDS)
        self.say(f"keys {chord}")
        self.tab.page.keyboard.press(chord)

    def drag(self):
        box = self.tab.page.evaluate(CANVAS)
        if box:
            self.say("drag in the picture")
            at = [box["x"] + box["width"] * self.random.random() for _ in range(2)]
            up = [box["y"] + box["height"] * self.random.random() for _ in range(2)]
            page = self.tab.page
            page.mouse.move(at[0], up[0])
            page.mouse.down()
            page.mouse.move(at[1], up[1], steps=3)
            page.mouse.up()

    def wheel(self):
        self.say("wheel")
        width, height = self.size()
        self.tab.page.mouse.move(width / 2, height / 2)
        self.tab.page.mouse.wheel(0, self.random.choice((-300, 300)))

    def mode(self):
        mode = self.random.choice(("design", "simulate", "calibrate", "optimize", "make", "runs"))
        self.say(f"mode {mode}")
        tab = self.tab.find(f"mode-{mode}")
        if tab.is_visible() and not self.tab.page.locator("[aria-modal=true]").count():
            tab.click()

    def reload(self):
        self.say("reload")
        self.tab.page.reload()
        self.connected(self.tab.page)

    def resize(self):
        width, height = self.random.choice(SIZES)
        self.say(f"window of {width} by {height}")
        self.tab.page.set_viewport_size({"width": width, "height": height})

    def second_tab(self):
        self.say("a second tab, closed again")
        other = self.tab.page.context.new_page()
        other.goto(f"{self.server.address}#mode=design")
        self.connected(other)
        other.close()

    def drop(self):
        name = self.random.choice(sorted(DROPPED))
        self.say(f"drop {name}")
        self.tab.page.evaluate(DROP, [name, DROPPED[name]])

    # Invariants

    def whole(self):
        """The page is whole and has logged no error."""
        page = self.tab.page
        until(
            lambda: page.evaluate(FAULT) == "",
            lambda: self.message(page.evaluate(FAULT)),
            PATIENCE,
        )
        # A refusal in words, as of a format that a body has not: the browser logs its status.
        errors = [error for error in self.tab.errors if "status of 422" not in error]
        assert errors == [], self.message(str(errors))

    def agree(self):
        """Page and server have one document, and the text that is seen is of it."""
        page = self.tab.page
        last = {}

        def same():
            last["known"] = document_of(self.server)
            return page.evaluate("window.voxsoft?.rev ?? 0") == last["known"]["rev"]

        until(same, lambda: self.message("page and server have documents of their own"), PATIENCE)
        lines = page.evaluate(
            "[...document.querySelectorAll('[data-testid=text-editor] .cm-line')]"
            ".filter((line) => line.checkVisibility()).map((line) => line.textContent)"
        )
        text = last["known"]["text"]
        typed = page.evaluate("document.activeElement?.closest('.cm-editor') !== null")
        strange = [line for line in lines if line.strip() and line not in text]
        assert typed or not strange, self.message(f"lines of no document: {strange}")

    def back_to_the_start(self):
        """All changes are taken back, one by one: then the first document is there again.

        One that was left without a change for another one is no change to take back.
        """
        page = self.tab.page
        page.keyboard.press("Escape")
        page.keyboard.press("Escape")
        undo = page.get_by_role("button", name="Undo (Ctrl+Z)", exact=True)
        for _ in range(2000):
            known = document_of(self.server)
            if known["text"] == self.first["text"]:
                return
            if not (known["can_undo"] or known["before"]):
                break
            undo.click()
            if not known["can_undo"]:
                back = self.tab.find("toast").get_by_role("button", name="Back to")
                back.first.click()
            until(
                lambda rev=known["rev"]: document_of(self.server)["rev"] != rev,
                lambda: self.message("undo changes nothing"),
                PATIENCE,
            )
        assert known["id"] != self.first["id"], self.message("undo does not lead to the start")

    def jobs(self):
        return self.tab.page.locator("[data-testid^=job-]").count()

    def size(self):
        return self.tab.page.evaluate("[innerWidth, innerHeight]")

    def connected(self, page):
        link = page.locator("[data-testid=link]").get_by_text("connected", exact=True)
        link.wait_for(timeout=PATIENCE * 1000)

    def message(self, fault):
        last = "\n  ".join(self.done[-25:])
        return f"seed {self.seed}, action {len(self.done)}: {fault}; the last actions:\n  {last}"
