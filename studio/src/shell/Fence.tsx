// Replacement for a pane, or the whole page, once an error has taken it down.
import { Component, type ReactNode } from "react";
import { Button, Empty } from "../controls/Choice";

const NO_WEBGL =
  "This browser draws no WebGL, which bodies are drawn by. Turn on hardware acceleration or WebGL in its settings, or take another browser.";

interface FenceProps {
  children: ReactNode;
  /** Content shown instead; `again` tries the pane once more. */
  instead(error: Error, again: () => void): ReactNode;
}

class Fence extends Component<FenceProps, { error: Error | null }> {
  override state = { error: null as Error | null };

  static getDerivedStateFromError(error: unknown) {
    return { error: error instanceof Error ? error : new Error(String(error)) };
  }

  override render() {
    const { error } = this.state;
    if (!error) return this.props.children;
    return this.props.instead(error, () => this.setState({ error: null }));
  }
}

/** A pane that fails says so and leaves the others alone. */
export function PaneFence(props: { title: string; children: ReactNode }) {
  return (
    <Fence
      instead={(error, again) => (
        <Empty title={`${props.title} stopped working`}>
          <p>{error.message}</p>
          <Button onClick={again}>Try again</Button>
        </Empty>
      )}
    >
      {props.children}
    </Fence>
  );
}

/** The last resort: an error that no pane has held, as one while a pane is taken away. */
export function PageFence(props: {
  children: ReactNode;
  /** Present place of the design and its runs, and other help. */
  comfort: string;
  resetLayout?: () => void;
}) {
  const { comfort, resetLayout } = props;
  return (
    <Fence
      instead={(error) => (
        <div className="page-fence" role="alert" data-testid="page-fence">
          <Empty title="The page stopped working">
            <p>{error.message}</p>
            <p>{/webgl/i.test(error.message) ? NO_WEBGL : comfort}</p>
            <Button kind="primary" onClick={() => location.reload()}>
              Reload
            </Button>
            {resetLayout && (
              <Button
                onClick={() => {
                  resetLayout();
                  location.reload();
                }}
              >
                Reset the layout and reload
              </Button>
            )}
          </Empty>
        </div>
      )}
    >
      {props.children}
    </Fence>
  );
}
