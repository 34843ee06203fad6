// The three questions of New: each answer leaves those of the others that still lead somewhere.
import type { Way } from "../protocol";

export type Question = "drive" | "form" | "task";
export type Answers = Readonly<Partial<Record<Question, string>>>;

export interface Asked {
  readonly question: Question;
  readonly words: string;
  readonly answers: readonly { readonly value: string; readonly label: string }[];
}

export const QUESTIONS: readonly Asked[] = [
  {
    question: "drive",
    words: "What moves it?",
    answers: [
      { value: "pressure", label: "Pressure" },
      { value: "tendon", label: "Tendons" },
      { value: "magnet", label: "A magnetic field" },
      { value: "heat", label: "Heat" },
    ],
  },
  {
    question: "form",
    words: "What shape has it?",
    answers: [
      { value: "finger", label: "Finger" },
      { value: "bellows", label: "Bellows" },
      { value: "trunk", label: "Trunk" },
      { value: "cylinder", label: "Cylinder" },
    ],
  },
  {
    question: "task",
    words: "What should it do?",
    answers: [
      { value: "bend", label: "Bend" },
      { value: "extend", label: "Extend" },
      { value: "grip", label: "Grip" },
      { value: "lift", label: "Lift" },
    ],
  },
];

/** The ways that agree with some answers. */
export function open(ways: readonly Way[], answers: Answers): Way[] {
  return ways.filter((way) =>
    QUESTIONS.every(({ question }) => {
      const answer = answers[question];
      return answer === undefined || way[question] === answer;
    }),
  );
}

/** Check if an answer leads to a robot, with those given to the questions before it. */
export function leads(
  ways: readonly Way[],
  answers: Answers,
  question: Question,
  value: string,
): boolean {
  return open(ways, { ...before(answers, question), [question]: value }).length > 0;
}

/** Give an answer; those to later questions stay where they still lead somewhere. */
export function answer(
  ways: readonly Way[],
  answers: Answers,
  question: Question,
  value: string,
): Answers {
  let given: Answers = { ...before(answers, question), [question]: value };
  for (const later of QUESTIONS.slice(place(question) + 1)) {
    const kept = answers[later.question];
    const left = later.answers.filter((one) => leads(ways, given, later.question, one.value));
    // A question that has one answer left is answered.
    const next = left.some((one) => one.value === kept)
      ? kept
      : left.length === 1
        ? left[0]?.value
        : undefined;
    if (next === undefined) break;
    given = { ...given, [later.question]: next };
  }
  return given;
}

/** Robot for the answers once all questions have one. */
export function found(ways: readonly Way[], answers: Answers): Way | null {
  if (QUESTIONS.some(({ question }) => answers[question] === undefined)) return null;
  return open(ways, answers)[0] ?? null;
}

function place(question: Question): number {
  return QUESTIONS.findIndex((one) => one.question === question);
}

function before(answers: Answers, question: Question): Answers {
  const earlier = QUESTIONS.slice(0, place(question)).map((one) => one.question);
  return Object.fromEntries(
    earlier.flatMap((one) => (answers[one] === undefined ? [] : [[one, answers[one]]])),
  );
}
