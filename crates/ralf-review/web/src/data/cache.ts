/** Remembers the last so many answers; what failed is asked for again. */
export class Cache<Value> {
  private readonly entries = new Map<string, Promise<Value>>();

  constructor(private readonly room: number) {}

  get(key: string, read: () => Promise<Value>): Promise<Value> {
    const known = this.entries.get(key);
    if (known !== undefined) {
      this.put(key, known);
      return known;
    }
    const coming = read();
    this.put(key, coming);
    coming.catch(() => {
      if (this.entries.get(key) === coming) this.entries.delete(key);
    });
    return coming;
  }

  put(key: string, value: Promise<Value>): void {
    this.entries.delete(key);
    this.entries.set(key, value);
    const oldest = this.entries.keys().next();
    if (this.entries.size > this.room && oldest.done !== true) this.entries.delete(oldest.value);
  }

  clear(): void {
    this.entries.clear();
  }

  forget(key: string): void {
    this.entries.delete(key);
  }
}
