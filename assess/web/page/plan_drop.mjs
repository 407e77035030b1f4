// Dragging from a list onto the plan: a rectangle of the piece's size follows the pointer and snaps; Enter puts it in the middle.

import { corners, roundTo } from "./plan_geometry.mjs";
import { isDrag } from "./plan_pointer.mjs";
import { el } from "./elements.mjs";

/**
 * @param {HTMLElement} list its buttons of the class draggable are dragged
 * @param {object} view the plan
 * @param {(button: HTMLElement) => {size: () => {breadth, width, angle}, drop: (at: number[]) => void}} find
 */
export function dragFrom(list, view, find) {
  let held = null; // {from, button, size, drop}
  let ghost = null;
  const end = () => {
    held = null;
    ghost?.remove();
    ghost = null;
    view.scene.sketch();
  };
  const buttonOf = ({ target }) => target.closest(".draggable:not(:disabled)");
  list.addEventListener("pointerdown", (event) => {
    const button = buttonOf(event);
    if (event.button !== 0 || !button) return;
    held = { from: [event.clientX, event.clientY], button, ...find(button) };
    button.setPointerCapture(event.pointerId);
  });
  list.addEventListener("pointermove", (event) => {
    if (!held || (!ghost && !isDrag(held.from, [event.clientX, event.clientY]))) return;
    if (!ghost) document.body.append((ghost = el("div", { class: "plan-ghost", text: held.button.innerText })));
    ghost.style.setProperty("transform", `translate(${event.clientX + 12}px, ${event.clientY + 12}px)`);
    const found = aim(view, event, held.size());
    ghost.hidden = found !== null;
    view.scene.sketch(found ? [{ name: "drawn", points: corners(found.piece), isClosed: true }, ...found.guides.map((points) => ({ name: "guide", points }))] : []);
  });
  list.addEventListener("pointerup", (event) => {
    if (!held) return;
    const found = ghost ? aim(view, event, held.size()) : null;
    const { drop } = held;
    end();
    if (found) drop([found.piece.x, found.piece.y]);
  });
  list.addEventListener("pointercancel", end);
  list.addEventListener("keydown", (event) => {
    if (event.key === "Escape" && ghost) end();
    const button = buttonOf(event);
    if (event.key !== "Enter" || !button) return;
    event.preventDefault();
    find(button).drop(view.viewport.centre.map((one) => roundTo(one, 0.01)));
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
