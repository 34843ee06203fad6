"""Files that are dropped on the page, as a file manager drops them."""

import base64

DATA = """([name, content]) => {
  const data = new DataTransfer();
  const bytes = Uint8Array.from(atob(content), (letter) => letter.charCodeAt(0));
  data.items.add(new File([bytes], name));
  return data;
}"""


def drag(tab, name, content, selector="body"):
    """Drag a file over an element, without letting it go; give what is dragged."""
    content = content.encode() if isinstance(content, str) else content
    data = tab.page.evaluate_handle(DATA, [name, base64.b64encode(content).decode()])
    tab.page.dispatch_event(selector, "dragover", {"dataTransfer": data})
    return data


def drop(tab, name, content, selector="body"):
    """Drop a file on an element."""
    data = drag(tab, name, content, selector)
    tab.page.dispatch_event(selector, "drop", {"dataTransfer": data})
