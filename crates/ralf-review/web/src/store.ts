/** One state; views watch parts of it and actions set it. Nothing else holds what the page knows. */

export class Store<State extends object> {
  private readonly watchers = new Set<() => void>();
  private telling = false;
  private changed = false;

  constructor(private current: State) {}

  get state(): Readonly<State> {
    return this.current;
  }

  set(patch: Partial<State>): void {
    this.current = { ...this.current, ...patch };
    this.changed = true;
    if (this.telling) return;
    this.telling = true;
    try {
      while (this.changed) {
        this.changed = false;
        for (const tell of [...this.watchers]) tell();
      }
    } finally {
      this.telling = false;
    }
  }

  /** Calls `react` now and whenever one of the selected values is another. Returns what ends it. */
  watch<Selected extends unknown[]>(
    select: (state: Readonly<State>) => [...Selected],
    react: NoInfer<(...selected: Selected) => void>,
  ): () => void {
    let seen = select(this.current);
    const tell = (): void => {
      const now = select(this.current);
      if (now.every((value, index) => Object.is(value, seen[index]))) return;
      seen = now;
      react(...now);
    };
    this.watchers.add(tell);
    react(...seen);
    return () => this.watchers.delete(tell);
  }
}
