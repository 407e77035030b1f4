// Light and dark: as the system, or as chosen on this machine.

import { choose } from "./elements.mjs";
import { t } from "./texts.mjs";

const KEY = "assess-theme";

/** Set the theme, or the one that was chosen earlier, and return it; "" is that of the system. */
export function keepTheme(theme) {
  try { // the browser may keep nothing: then it holds for this visit
    if (theme !== undefined) localStorage.setItem(KEY, theme);
    theme ??= localStorage.getItem(KEY);
  } catch {
    theme ??= "";
  }
  if (theme) document.documentElement.dataset.theme = theme;
  else delete document.documentElement.dataset.theme;
  return theme ?? "";
}

export function themeSwitch() {
  const select = choose([["", t("Automatic")], ["light", t("Light")], ["dark", t("Dark")]], keepTheme());
  select.addEventListener("change", () => keepTheme(select.value));
  return select;
}
