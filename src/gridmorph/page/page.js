// One step at a time instead of all of them, with a slider; without scripts all are shown.
for (const steps of document.querySelectorAll(".steps")) {
  const figures = [...steps.querySelectorAll("figure")];
  if (figures.length < 2) continue;
  const bar = document.createElement("div");
  bar.className = "slider";
  const play = document.createElement("button");
  play.type = "button";
  const input = document.createElement("input");
  input.type = "range";
  input.min = 0;
  input.max = figures.length - 1;
  input.setAttribute("aria-label", "step");
  let timer = 0;
  const show = (n) => {
    figures.forEach((f, k) => f.classList.toggle("now", k === n));
    input.value = n;
    input.setAttribute("aria-valuetext", figures[n].querySelector("figcaption").textContent);
  };
  const stop = () => {
    clearInterval(timer);
    timer = 0;
    play.textContent = "Play";
  };
  play.addEventListener("click", () => {
    if (timer) return stop();
    play.textContent = "Pause";
    timer = setInterval(() => show((+input.value + 1) % figures.length), 200);
  });
  input.addEventListener("input", () => {
    stop();
    show(+input.value);
  });
  bar.append(play, input);
  steps.classList.add("one");
  steps.after(bar);
  stop();
  show(+steps.dataset.shown || 0);
}
// Notes that are folded on the screen belong on paper too.
addEventListener("beforeprint", () => document.querySelectorAll("details").forEach((d) => (d.open = true)));
