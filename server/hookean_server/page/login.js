// The token comes behind the # of the address, which browsers do not send; it is exchanged for a cookie once.
"use strict";
const token = new URLSearchParams(location.hash.slice(1)).get("t");
if (token) {
  history.replaceState(null, "", location.pathname);
  fetch("/v1/login", { method: "POST", headers: { Authorization: "Bearer " + token } }).then((answer) => {
    document.getElementById("login").textContent = answer.ok
      ? "This browser is logged in until it or the service ends."
      : "The token is not that of this start of the service: hookean token --url prints the right address.";
  });
}
