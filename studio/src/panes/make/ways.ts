// Ways to make a robot, in words.

export const WAYS: Readonly<Record<string, string>> = {
  cast: "Cast in one mold",
  core: "Cast around a core that is drawn out",
  halves: "Cast in halves and bonded",
  "lost-core": "Cast around a core that is lost",
  printed: "Printed directly",
};

/** The way that is taken where none is asked for. */
export const FIRST = "the first that the shape allows";
