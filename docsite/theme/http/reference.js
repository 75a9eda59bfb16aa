// The reference in the colours that were chosen on the other pages, or else in those of the system.
const chosen = JSON.parse(localStorage.getItem(new URL("../.__palette", location).pathname))?.color?.scheme;
const dark = chosen ? chosen === "slate" : matchMedia("(prefers-color-scheme: dark)").matches;
document.documentElement.classList.toggle("dark-mode", dark);

SwaggerUIBundle({
  url: new URL("openapi.json", location).href,
  dom_id: "#reference",
  deepLinking: true,
  defaultModelsExpandDepth: -1,
  docExpansion: "list",
  filter: true,
  validatorUrl: null,
});
