import { useState } from "react";
import { Button } from "../controls/Choice";
import type { Robot, Way } from "../protocol";
import { openRobot } from "./begin";
import { type Answers, answer, found, leads, QUESTIONS } from "./ways";

/** Three questions that lead to a robot to begin with. */
export function NewRobot(props: { ways: readonly Way[]; robots: readonly Robot[] }) {
  const { ways, robots } = props;
  const [answers, setAnswers] = useState<Answers>({});
  const way = found(ways, answers);
  const robot = way && robots.find((one) => one.name === way.robot);
  return (
    <section className="new-robot" aria-label="New robot" data-testid="new-robot">
      <div className="questions">
        {QUESTIONS.map(({ question, words, answers: offered }) => (
          <fieldset key={question}>
            <legend>{words}</legend>
            {offered.map(({ value, label }) => {
              const possible = leads(ways, answers, question, value);
              return (
                <label key={value} className={possible ? "answer" : "answer impossible"}>
                  <input
                    type="radio"
                    name={question}
                    value={value}
                    disabled={!possible}
                    checked={answers[question] === value}
                    onChange={() => setAnswers(answer(ways, answers, question, value))}
                  />
                  {label}
                </label>
              );
            })}
          </fieldset>
        ))}
      </div>
      <div className="new-found" aria-live="polite">
        {way && robot ? (
          <>
            <img src={robot.picture} alt="" width="480" height="320" />
            <div>
              <strong>{robot.title}</strong>
              <p className="muted">{way.sentence}</p>
              <Button
                kind="primary"
                testId="new-begin"
                onClick={() => openRobot("start", way.name)}
              >
                Begin with it
              </Button>
            </div>
          </>
        ) : (
          <p className="muted">
            Three answers lead to a robot to begin with. All of it can be changed afterwards.
          </p>
        )}
      </div>
    </section>
  );
}
