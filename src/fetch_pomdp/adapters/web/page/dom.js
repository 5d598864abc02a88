// Elements of the document, found and made.

/**
 * The element of a selector; kind: its class. Throws for none, or one of another class.
 * @template {Element} T
 * @overload
 * @param {string} selector
 * @param {new () => T} kind
 * @returns {T}
 */
/**
 * @overload
 * @param {string} selector
 * @returns {HTMLElement}
 */
/** @param {string} selector */
export function find(selector, kind = HTMLElement) {
  const found = document.querySelector(selector);
  if (!(found instanceof kind)) throw new TypeError(`found ${found} at ${selector}, expected one ${kind.name}`);
  return found;
}

/**
 * All elements of a selector that are of a class.
 * @template {Element} T
 * @param {string} selector
 * @param {new () => T} kind
 * @returns {T[]}
 */
export function findAll(selector, kind) {
  return [...document.querySelectorAll(selector)].flatMap((each) => (each instanceof kind ? [each] : []));
}

/**
 * A new element with properties and children; an empty `lang` is left out.
 * @template {keyof HTMLElementTagNameMap} N
 * @param {N} name
 * @param {Partial<HTMLElementTagNameMap[N]>} properties
 * @param {(Node | string)[]} children
 * @returns {HTMLElementTagNameMap[N]}
 */
export function create(name, { lang, ...properties } = {}, ...children) {
  const made = Object.assign(document.createElement(name), properties);
  if (lang) made.lang = lang;
  made.append(...children);
  return made;
}
