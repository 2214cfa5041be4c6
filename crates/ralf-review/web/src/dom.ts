/** Elements in one expression. Styles are classes; what must be computed goes through `style.setProperty`. */

type Child = Node | string | null;

export interface Attributes {
  readonly class?: string;
  readonly on?: { readonly [Kind in keyof HTMLElementEventMap]?: (event: HTMLElementEventMap[Kind]) => void };
  readonly [attribute: `aria-${string}` | `data-${string}`]: string;
  readonly id?: string;
  readonly role?: string;
  readonly title?: string;
  readonly type?: string;
  readonly value?: string;
  readonly tabindex?: string;
  readonly placeholder?: string;
  readonly step?: string;
  readonly min?: string;
  readonly max?: string;
  readonly for?: string;
  readonly scope?: string;
  readonly maxlength?: string;
  readonly method?: string;
}

export function h<Tag extends keyof HTMLElementTagNameMap>(
  tag: Tag,
  { on, ...attributes }: Attributes = {},
  ...children: readonly Child[]
): HTMLElementTagNameMap[Tag] {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, String(value));
  for (const [kind, listener] of Object.entries(on ?? {})) element.addEventListener(kind, listener as EventListener);
  for (const child of children) if (child !== null) element.append(child);
  return element;
}

let knownScale: number | null = null;

/** How much larger text is than on a small screen. Styles are asked once for each size of the window. */
export function textScale(): number {
  if (knownScale !== null) return knownScale;
  window.addEventListener("resize", () => (knownScale = null), { once: true });
  knownScale = Number(getComputedStyle(document.documentElement).getPropertyValue("--scale")) || 1;
  return knownScale;
}

/** Puts other children in; leaves the element alone where its text would stay the same. */
export function say(element: HTMLElement, text: string): void {
  if (element.textContent !== text) element.textContent = text;
}

export function pressed(button: HTMLElement, is: boolean): void {
  button.setAttribute("aria-pressed", String(is));
}

export interface Option {
  readonly value: string;
  readonly text: string;
  readonly meaning?: string;
}

/** A labelled list to choose from. */
export function select(label: string, options: readonly Option[], chosen: (value: string) => void): HTMLSelectElement {
  const list = h("select", { "aria-label": label, on: { change: () => chosen(list.value) } });
  setOptions(list, options);
  return list;
}

export function setOptions(list: HTMLSelectElement, options: readonly Option[]): void {
  list.replaceChildren(...options.map(({ value, text, meaning = "" }) => h("option", { value, title: meaning }, text)));
}

/** Keeps a child for each item. One whose key stays is the same element: focus and a press that has begun stay. */
export function childrenOf<T>(
  parent: HTMLElement,
  keyOf: (item: T) => unknown,
  make: (item: T) => HTMLElement,
  show: (child: HTMLElement, item: T) => void = () => undefined,
): (items: readonly T[]) => void {
  let known = new Map<unknown, HTMLElement>();
  return (items) => {
    const now = new Map(items.map((item) => [keyOf(item), known.get(keyOf(item)) ?? make(item)] as const));
    for (const [key, child] of known) if (!now.has(key)) child.remove();
    let next = parent.firstElementChild;
    for (const item of items) {
      const child = now.get(keyOf(item));
      if (child === undefined) continue;
      if (child === next) next = next.nextElementSibling;
      else parent.insertBefore(child, next);
      show(child, item);
    }
    known = now;
  };
}
