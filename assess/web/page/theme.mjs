// Light and dark: as the system, or as chosen on this machine.

import { choose } from "./elements.mjs";
import { t } from "./texts.mjs";

const KEY = "assess-theme";

function read() {
  try {
    return localStorage.getItem(KEY) ?? "";
  } catch {
    return ""; // where the browser keeps nothing
  }
}

/** Set the theme that was chosen earlier. */
export function keepTheme() {
  setTheme(read());
}

function setTheme(theme) {
  if (theme) document.documentElement.dataset.theme = theme;
  else delete document.documentElement.dataset.theme;
}

export function themeSwitch() {
  const options = [["", t("Automatic")], ["light", t("Light")], ["dark", t("Dark")]];
  const select = choose(options, read());
  select.addEventListener("change", () => {
    setTheme(select.value);
    try {
      localStorage.setItem(KEY, select.value);
    } catch {
      // it holds for this visit
    }
  });
  return select;
}
