// Registers the element where there is a page; where a server renders one there is nothing to register.
import './flaneur-tour.js';

export const FlaneurTour = globalThis.customElements?.get('flaneur-tour');
