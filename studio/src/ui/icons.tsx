// Signs for what makes a session go.
const MARKS = {
  play: "M4 2.5v11l9-5.5z",
  pause: "M4 3h3v10H4zM9 3h3v10H9z",
  step: "M3 2.5v11l7-5.5zM11 3h2v10h-2z",
  rest: "M2 2.5v11l6-5.5zM8 2.5v11l6-5.5z",
  reset: "M3 3h2v10H3zM13 2.5v11L6 8z",
  undo: "M6 2 2 6l4 4V7.2h3.5a2.6 2.6 0 0 1 0 5.2H6V14h3.5a4.3 4.3 0 0 0 0-8.6H6z",
  redo: "m10 2 4 4-4 4V7.2H6.500a2.600 2.600 0 0 0 0 5.200H10V14H6.500a4.300 4.300 0 0 1 0-8.600H10z",
} as const;

export type Mark = keyof typeof MARKS;

export function Icon({ mark }: { mark: Mark }) {
  return (
    <svg viewBox="0 0 16 16" width="16" height="16" aria-hidden="true" fill="currentColor">
      <path d={MARKS[mark]} />
    </svg>
  );
}
