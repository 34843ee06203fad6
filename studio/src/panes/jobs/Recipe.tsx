// Ways to repeat a job without the studio: as Python, or as a command line.
import { useEffect } from "react";
import { Button } from "../../controls/Choice";
import { copy } from "../../controls/clipboard";
import type { RecipeEvent } from "../../protocol";
import { send } from "../../store/session";
import { useStudio } from "../../store/studio";

/** The recipe of a job, asked for as soon as it is wanted; null until it has come. */
function useRecipe(job: string): RecipeEvent | null {
  const known = useStudio((state) => state.recipes[job]);
  const open = useStudio((state) => state.link.state === "open");
  useEffect(() => {
    if (!known && open) send({ t: "recipe", id: job });
  }, [job, known, open]);
  return known ?? null;
}

/** Buttons that copy it. */
export function RecipeButtons(props: { job: string }) {
  const recipe = useRecipe(props.job);
  return (
    <div className="recipe-buttons">
      <Button
        kind="quiet"
        testId="copy-python"
        label="Copy a script that does this again"
        disabled={recipe === null}
        onClick={() => recipe && void copy(recipe.python, "the script")}
      >
        Copy as Python
      </Button>
      <Button
        kind="quiet"
        testId="copy-command"
        label={
          recipe && !recipe.command
            ? "The command line has no option for all that was chosen; the script has"
            : "Copy a command that does this again"
        }
        disabled={!recipe?.command}
        onClick={() => recipe && void copy(recipe.command, "the command")}
      >
        Copy command
      </Button>
    </div>
  );
}

/** The command in sight, with seed and version, below the list of runs. */
export function Reproduce(props: { job: string }) {
  const recipe = useRecipe(props.job);
  const told = [
    recipe?.seed != null ? `seed ${recipe.seed}` : "",
    recipe?.version ? `VoxSoft ${recipe.version}` : "",
  ].filter(Boolean);
  return (
    <section className="reproduce" data-testid="reproduce" aria-label={`Do ${props.job} again`}>
      <div className="reproduce-head">
        <strong>Do it again</strong>
        <span className="muted">{told.join(" · ")}</span>
        <RecipeButtons job={props.job} />
      </div>
      {recipe?.command ? (
        <code>{recipe.command}</code>
      ) : (
        recipe && <p className="muted">The command line has no option for all that was chosen.</p>
      )}
    </section>
  );
}
