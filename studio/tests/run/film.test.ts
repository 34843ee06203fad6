import { expect, it } from "vitest";
import type { Moment } from "../../src/protocol";
import { momentAt, newestFilm } from "../../src/run/film";

const moment = (frame: number, time: number): Moment => ({
  frame,
  time,
  poses: [],
  contacts: [],
  fields: false,
  depth: null,
});
const known = (...moments: Moment[]) => new Map(moments.map((one) => [one.frame, one]));

it("shows the newest of several solutions", () => {
  const all = known(moment(1, 0), moment(2, 0.1), moment(4, 0.05), moment(3, 0), moment(5, 0.1));
  expect(newestFilm(all).map((one) => one.frame)).toEqual([3, 4, 5]);
});

it("finds no film in an equilibrium, which has no time", () => {
  expect(newestFilm(known(moment(1, 0), moment(2, 0)))).toHaveLength(1);
  expect(newestFilm(known())).toHaveLength(0);
});

it("stays at a frame until the next one's time has come", () => {
  const film = [moment(3, 0), moment(4, 0.05), moment(5, 0.1)];
  const frames = [-1, 0.049, 0.05, 7].map((time) => momentAt(film, time)?.frame);
  expect(frames).toEqual([3, 3, 4, 5]);
});
