// Dragging from a list onto the plan: a rectangle of the piece's size follows the pointer and snaps; Enter puts it in the middle.

import { corners, roundTo } from "./plan_geometry.mjs";
import { isDrag } from "./plan_pointer.mjs";
import { el } from "./elements.mjs";

/**
 * @param {HTMLElement} button a row of the list
 * @param {{view: object, size: () => {breadth, width, angle}, drop: (at: number[]) => void}} options
 */
export function dragOnto(button, { view, size, drop }) {
  let from = null;
  let ghost = null;
  const end = () => {
    from = null;
    ghost?.remove();
    ghost = null;
    view.scene.sketch();
  };
  button.addEventListener("pointerdown", (event) => {
    if (event.button !== 0 || button.disabled) return;
    from = [event.clientX, event.clientY];
    button.setPointerCapture(event.pointerId);
  });
  button.addEventListener("pointermove", (event) => {
    if (!from || (!ghost && !isDrag(from, [event.clientX, event.clientY]))) return;
    if (!ghost) document.body.append((ghost = el("div", { class: "plan-ghost", text: button.textContent })));
    ghost.style.setProperty("transform", `translate(${event.clientX + 12}px, ${event.clientY + 12}px)`);
    const found = aim(view, event, size());
    ghost.hidden = found !== null;
    view.scene.sketch(found ? [{ name: "drawn", points: corners(found.piece), isClosed: true }, ...found.guides.map((points) => ({ name: "guide", points }))] : []);
  });
  button.addEventListener("pointerup", (event) => {
    const found = ghost ? aim(view, event, size()) : null;
    end();
    if (found) drop([found.piece.x, found.piece.y]);
  });
  button.addEventListener("pointercancel", end);
  button.addEventListener("keydown", (event) => {
    if (event.key === "Escape" && ghost) end();
    if (event.key !== "Enter") return;
    event.preventDefault();
    drop(view.viewport.centre.map((one) => roundTo(one, 0.01)));
  });
}

/** Where a piece would stand under the pointer; null outside the drawing. */
function aim(view, event, size) {
  const box = view.svg.getBoundingClientRect();
  const { clientX: x, clientY: y } = event;
  if (x < box.left || x > box.right || y < box.top || y > box.bottom) return null;
  const [wx, wy] = view.viewport.toWorld(view.viewport.toLocal(x, y));
  const { at, guides } = view.select.snapNew({ ...size, x: wx, y: wy }, event.altKey);
  return { piece: { ...size, x: at[0], y: at[1] }, guides };
}
