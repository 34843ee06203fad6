// A design that holds nothing yet, beside the templates.
import type { Template } from "../../protocol";

export const EMPTY: Template = { name: "empty", title: "Nothing yet: add shapes", text: "" };
