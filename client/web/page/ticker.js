// A worker that tells its page twice a second that time has passed. Browsers slow the timers of hidden
// pages down to one call a minute, but not those of workers.
"use strict";
setInterval(() => postMessage(null), 500);
