// Starts the page: the frame with its tabs, and the views as they are asked for.

import { buildFrame } from "./frame.mjs";
import { store } from "./store.mjs";
import { loadTexts } from "./texts.mjs";
import { keepTheme } from "./theme.mjs";

keepTheme();
await loadTexts();
await buildFrame(store).start();
